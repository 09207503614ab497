// This file finds the rotation and the time offset between two sensors that both measure how they
// turn.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tools/calibrate/extrinsics/rotation_stream.h"

namespace maploop::extrinsics {

// How similarly two sensors turn if the stamps of one are `delay` later than those of the other.
struct RateCorrelation {
  double delay = 0.0;  // s
  double value =
      0.0;  // 1: the rates are the same but for a rotation; 0: they have nothing in common
};

// Returns, for delays from -`most` to `most` (s) in steps of `step`, the correlation of the rates
// (without their means, and limited to four times their medians) under the rotation that makes it
// largest:
//   c = sum of the singular values of (sum a_k b_k^T) / sqrt(sum |a_k|^2 sum |b_k|^2),
// the smallest value with the sign of the determinant (Kabsch, Acta Crystallographica A32, 1976).
// `a` is the mean rate of the stream during the motion of b, `delay` later. No rotation has to be
// known for it. A delay at which fewer than half of the motions are covered is left out.
std::vector<RateCorrelation> correlate(const RotationStream& a, std::span<const SensorMotion> b,
                                       double most, double step = 0.01);

// This is what is known of the two sensors before the alignment.
struct AlignmentStart {
  Eigen::Matrix3d R_a_b = Eigen::Matrix3d::Identity();
  double rotation_sigma = 0.17;  // rad, of each axis: ten degrees
  double delay_sigma = 0.3;      // s, from zero
  double bias_sigma = 0.01;      // rad/s, of a's rates; 0: they have none
  // The delay is taken from turns about b's third axis alone, where the other rates of a LiDAR are
  // late: on KITTI's drive 0013, pitching and rolling by 25 ms, and turning not at all.
  bool delay_by_third_axis = false;
};

enum class AlignmentStatus : std::uint8_t {
  ok,
  too_short,   // fewer than 20 motions, or less than 6 s, are covered by both
  no_turning,  // neither sensor turns by more than its noise
  unrelated,   // the rates have too little in common at any delay
};

struct RateAlignment {
  AlignmentStatus status = AlignmentStatus::too_short;
  double correlation = 0.0;
  int motions = 0;
  Eigen::Matrix3d R_a_b = Eigen::Matrix3d::Identity();
  double delay = 0.0;                               // s, by which a's stamps are later than b's
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();   // rad/s, of a
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();  // rad/s, 1 sigma of a motion's residual
  // The order is: rotation vector in a's axes that turns R_a_b (rad), delay (s), bias (rad/s).
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();

  Eigen::Vector3d rotation_sigma() const { return covariance.diagonal().head<3>().cwiseSqrt(); }
  double delay_sigma() const { return std::sqrt(covariance(3, 3)); }
};

// Solves a(t_k + delay) = R_a_b b_k + bias for all motions k of b, by least squares that give
// little weight to outliers (robust_fit.h). It starts from the delay of the largest correlation,
// and from the rotation that is given or the one of that correlation, whichever ends better. Where
// a measures its vertical rate alone, only that component is compared: the turn of b about a's
// vertical axis then keeps its start and its large standard deviation.
RateAlignment align(const RotationStream& a, std::span<const SensorMotion> b,
                    const AlignmentStart& start);

}  // namespace maploop::extrinsics
