// The change of a camera's velocity between two successive motions is computed here.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace maploop::stereo {

// `value` is the second motion's velocity minus the first one's: translation (m/s) and rotation
// vector (rad/s), each divided by the time of its motion and in the axes at its own start.
// `by_pose` holds the derivatives with respect to the perturbations (residual.h) of the three
// poses.
struct VelocityChange {
  Eigen::Matrix<double, 6, 1> value;
  std::array<Eigen::Matrix<double, 6, 6>, 3> by_pose;
};

// The motion from poses[0] to poses[1] takes seconds[0], that from poses[1] to poses[2] seconds[1];
// both must be > 0.
VelocityChange velocity_change(const std::array<Eigen::Isometry3d, 3>& poses,
                               const std::array<double, 2>& seconds);

}  // namespace maploop::stereo
