// What a road vehicle can do between two pairs.
#pragma once

#include <optional>

#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// How the body moved when it was last known.
struct LastVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // m/s, body
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // rad/s, body
  double age = 0.0;  // s, from the end of its motion to the end of the one that is judged

  template <class Archive>
  void archive(Archive& ar) {
    ar(linear, angular, age);
  }
};

// `motion` in body over `seconds`. The change of velocity is judged with three standard deviations
// of the motion's own noise to spare.
bool plausible(const RelativeMotion& motion, double seconds,
               const std::optional<LastVelocity>& last, const StereoParameters& parameters);

// Rotation vector over time.
Eigen::Vector3d angular_velocity(const RelativeMotion& motion, double seconds);

}  // namespace maploop::stereo
