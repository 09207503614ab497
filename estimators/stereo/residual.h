// What a motion and a disparity predict of a track, and how that changes with them.
#pragma once

#include <Eigen/Geometry>

#include "estimators/stereo/triangulate.h"

namespace maploop::stereo {

// Prediction of the current (u, v, disparity) of the point that the previous left image shows at
// (u, v) with the given disparity. The pose is T_previous_current in cam; its six perturbations are
// a translation added to its own and a rotation vector multiplied from the left, both in cam at
// the previous epoch.
struct Prediction {
  ImagePoint image = ImagePoint::Zero();
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Vector3d by_disparity = Eigen::Vector3d::Zero();
  bool in_front = false;  // of the current camera; all else is zero where not
};

Prediction predict(const StereoCalibration& camera, const Eigen::Isometry3d& T_previous_current,
                   double u_left, double v_left, double disparity);

// The perturbation itself.
Eigen::Isometry3d perturbed(const Eigen::Isometry3d& T_previous_current,
                            const Eigen::Matrix<double, 6, 1>& perturbation);

}  // namespace maploop::stereo
