// This test decides whether a road vehicle can make a motion between two pairs.
#pragma once

#include <optional>

#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// Holds the last known velocity of the body.
struct LastVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // m/s, body
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // rad/s, body
  double age = 0.0;  // s, from the end of its motion to the end of the tested one

  template <class Archive>
  void archive(Archive& ar) {
    ar(linear, angular, age);
  }
};

// Tests `motion` in body over `seconds`. The limits of the change of velocity are widened by three
// standard deviations of the motion's own noise.
bool plausible(const RelativeMotion& motion, double seconds,
               const std::optional<LastVelocity>& last, const StereoParameters& parameters);

// Returns the rotation vector divided by `seconds`, rad/s.
Eigen::Vector3d angular_velocity(const RelativeMotion& motion, double seconds);

}  // namespace maploop::stereo
