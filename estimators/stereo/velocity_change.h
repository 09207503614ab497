// How much a camera's velocity changes between two successive motions.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace maploop::stereo {

// Translation (m/s) and rotation vector (rad/s), each per second of its motion and in the axes of
// its own start: the second motion's less the first one's; and the derivatives by the perturbations
// (residual.h) of the three poses.
struct VelocityChange {
  Eigen::Matrix<double, 6, 1> value;
  std::array<Eigen::Matrix<double, 6, 6>, 3> by_pose;
};

// poses[0] to poses[1] takes seconds[0], poses[1] to poses[2] seconds[1]; both > 0.
VelocityChange velocity_change(const std::array<Eigen::Isometry3d, 3>& poses,
                               const std::array<double, 2>& seconds);

}  // namespace maploop::stereo
