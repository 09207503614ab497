// This file joins the motions of a sensor to a path.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "tools/calibrate/extrinsics/rotation_stream.h"

namespace maploop::extrinsics {

// The path of a sensor in its first pose. After a gap between two motions, a new path begins.
class PoseChain {
 public:
  explicit PoseChain(std::span<const SensorMotion> motions);

  // Returns the sensor's motion between two stamps, both shifted by `shift` (s); nothing if a gap
  // lies between them. Between two poses the rotation is interpolated along the shortest way, and
  // the position by a cubic whose velocities are those of the motions beside it.
  std::optional<Eigen::Isometry3d> motion(Time from, Time to, double shift) const;

 private:
  struct Knot {
    double t = 0.0;  // s since the origin
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, in the first pose's axes
    int piece = 0;
  };
  const Knot* before(double t) const;
  static Eigen::Isometry3d between(const Knot& a, const Knot& b, double t);

  Time origin_{};
  std::vector<Knot> knots_;
};

}  // namespace maploop::extrinsics
