// This file holds what a sensor measured of its own turning, as a function of time.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "msgs/time.h"

namespace maploop::extrinsics {

// The pose of a sensor at `to` in its own axes at `from`.
struct SensorMotion {
  Time from{}, to{};
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();

  // Returns the mean rate of turn, rad/s, in the sensor's axes.
  Eigen::Vector3d rate() const;
};

// Returns the motions over as many successive steps as last `duration` (s) or little more, from
// each step on, so that they overlap: a fast camera turns by little more than its noise from one
// image to the next.
std::vector<SensorMotion> joined(std::span<const SensorMotion> motions, double duration);

struct RateSample {
  Time stamp{};
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // rad/s
};

// The integral of a sensor's rates of turn about its own axes, interpolated by cubics between the
// stamps. No mean is made across a gap in the measurements.
class RotationStream {
 public:
  RotationStream() = default;

  // Motions and samples are in the order of their stamps. Samples further apart than `longest_step`
  // (s) leave a gap between them. With `vertical_alone`, only z was measured.
  static RotationStream of_motions(std::span<const SensorMotion> motions);
  static RotationStream of_rates(std::span<const RateSample> samples, bool vertical_alone,
                                 double longest_step = 0.25);

  bool vertical_alone() const { return vertical_alone_; }
  bool empty() const { return knots_.empty(); }
  Time origin() const { return origin_; }

  // Returns the mean rate (rad/s) between two stamps, both shifted by `shift` (s); nothing if not
  // all of that time was measured.
  std::optional<Eigen::Vector3d> mean_rate(Time from, Time to, double shift) const;

 private:
  struct Knot {
    double t = 0.0;  // s since the origin
    Eigen::Vector3d integral = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    int piece = 0;  // a gap lies between two knots of different pieces
  };
  struct Value {
    Eigen::Vector3d integral;
    int piece;
  };

  std::optional<Value> at(double t) const;

  Time origin_{};
  std::vector<Knot> knots_;
  bool vertical_alone_ = false;
};

}  // namespace maploop::extrinsics
