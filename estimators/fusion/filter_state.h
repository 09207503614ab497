// State of the reduced-IMU filter (method.md 1.4, option B: total-state EKF in local metres).
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "msgs/frames.h"
#include "msgs/time.h"

namespace maploop::fusion {

// Order of the state vector.
namespace index {
enum : int {
  east,
  north,
  up,              // m, enu
  speed,           // m/s along body x, negative in reverse
  azimuth,         // rad, in (-pi, pi]
  pitch,           // rad
  roll,            // rad
  gyro_bias,       // rad/s, added to the yaw rate
  forward_bias,    // m/s^2, added to the forward specific force
  left_bias,       // m/s^2, added to the left specific force
  climb_offset,    // rad, direction of travel above body x: mounting and load
  odometry_scale,  // 1, odometry reports (1 + scale) times the distance
  distance,        // m, travelled since the clone
  clone_azimuth,   // rad, the attitude at the start of the odometry interval
  clone_pitch,
  clone_roll,
  count
};
}  // namespace index

using StateVector = Eigen::Matrix<double, index::count, 1>;
using StateMatrix = Eigen::Matrix<double, index::count, index::count>;

// Everything the filter knows at one moment; a copy of it is a snapshot.
struct FilterState {
  Time stamp{};
  StateVector x = StateVector::Zero();
  StateMatrix P = StateMatrix::Zero();
  Time clone_stamp{};
  Time start{};
  // Newest measurement of each kind inside (epoch 0: none).
  Time imu_stamp{};
  Time odometry_stamp{};
  std::uint64_t odometry_applied = 0;
  std::uint64_t odometry_refused = 0;
  int gated_in_a_row = 0;
  std::uint64_t recoveries = 0;

  Attitude attitude() const { return {x[index::azimuth], x[index::pitch], x[index::roll]}; }
  Attitude clone_attitude() const {
    return {x[index::clone_azimuth], x[index::clone_pitch], x[index::clone_roll]};
  }
};

template <class Archive>
void archive(Archive& ar, FilterState& s) {
  ar(s.stamp, s.x, s.P, s.clone_stamp, s.start, s.imu_stamp, s.odometry_stamp, s.odometry_applied,
     s.odometry_refused, s.gated_in_a_row, s.recoveries);
}

// Adds a correction, keeping both azimuths in (-pi, pi].
inline void add_correction(StateVector& x, const StateVector& correction) {
  x += correction;
  x[index::azimuth] = wrap_angle(x[index::azimuth]);
  x[index::clone_azimuth] = wrap_angle(x[index::clone_azimuth]);
}

// Takes the stochastic clone: attitude at this moment, fully correlated with the attitude; the
// distance starts again from a certain zero. Taking it twice changes nothing.
inline void take_clone(FilterState& state) {
  for (int i = 0; i < 3; ++i) {
    const int from = index::azimuth + i;
    const int to = index::clone_azimuth + i;
    state.x[to] = state.x[from];
    state.P.row(to) = state.P.row(from);
  }
  for (int i = 0; i < 3; ++i) {
    state.P.col(index::clone_azimuth + i) = state.P.col(index::azimuth + i);
  }
  state.x[index::distance] = 0.0;
  state.P.row(index::distance).setZero();
  state.P.col(index::distance).setZero();
  state.clone_stamp = state.stamp;
}

// Columns: how the body turns, as a rotation vector in enu, per radian of azimuth, pitch and roll.
// R(a + d) = exp(E d) R(a) to first order.
inline Eigen::Matrix3d attitude_rate_axes(const Attitude& a) {
  const double sA = std::sin(a.azimuth), cA = std::cos(a.azimuth);
  const double sp = std::sin(a.pitch), cp = std::cos(a.pitch);
  Eigen::Matrix3d axes;
  axes.col(0) << 0.0, 0.0, -1.0;        // clockwise seen from above
  axes.col(1) << cA, -sA, 0.0;          // about the horizontal axis to the right
  axes.col(2) << sA * cp, cA * cp, sp;  // about the forward axis
  return axes;
}

}  // namespace maploop::fusion
