// These functions predict a track's measurement from a motion and a disparity, with derivatives.
#pragma once

#include <Eigen/Geometry>

#include "estimators/stereo/triangulate.h"

namespace maploop::stereo {

// Holds what a camera at T_world_cam sees of a point, and the derivatives with respect to the
// pose's six perturbations (below) and the point.
struct View {
  ImagePoint image = ImagePoint::Zero();
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
  bool in_front = false;  // of the camera; if false, all else is zero
};

View view_point(const StereoCalibration& camera, const Eigen::Isometry3d& T_world_cam,
                const Eigen::Vector3d& p_world);

// Predicts the current (u, v, disparity), px, of the point that the previous left image shows at
// (u, v) with the given disparity. The pose is T_previous_current in cam. Its six perturbations are
// a translation added to its own and a rotation vector multiplied from the left, both in cam at the
// previous epoch.
struct Prediction {
  ImagePoint image = ImagePoint::Zero();
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Vector3d by_disparity = Eigen::Vector3d::Zero();
  bool in_front = false;  // of the current camera; if false, all else is zero
};

Prediction predict(const StereoCalibration& camera, const Eigen::Isometry3d& T_previous_current,
                   double u_left, double v_left, double disparity);

// Returns the perturbed pose.
Eigen::Isometry3d perturbed(const Eigen::Isometry3d& pose,
                            const Eigen::Matrix<double, 6, 1>& perturbation);

}  // namespace maploop::stereo
