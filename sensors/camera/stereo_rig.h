// This file describes two raw cameras, their relative pose, and how their images are rectified.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "msgs/calibration.h"
#include "sensors/camera/camera_model.h"

namespace maploop::sensors {

struct StereoRig {
  int width = 0, height = 0;  // px, of both raw images
  CameraModel left, right;
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();  // of the raw cameras

  // These rotations take the raw camera frame to the rectified one.
  Eigen::Matrix3d R_rect_left = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_rect_right = Eigen::Matrix3d::Identity();
  StereoCalibration rectified;  // T_body_cam is not set: see mounted()

  // Pose of the raw left camera in the body frame, if it is known.
  std::optional<Eigen::Isometry3d> T_body_left;
};

// Returns the rectified calibration of a rig whose raw left camera has the pose `T_body_left`.
StereoCalibration mounted(const StereoRig& rig, const Eigen::Isometry3d& T_body_left);

// Returns what is wrong with the rig, or nothing. It checks sizes, focal lengths, a distortion that
// turns back in most of the image, matrices that are not rotations (to 1e-6), and a rectification
// that does not fit the extrinsics (rows apart by more than half a pixel at the far corners, or a
// different baseline).
std::optional<std::string> problem_of(const StereoRig& rig);

// Returns the rotation nearest to a matrix of rounded numbers, or nothing if it is not a rotation
// to 1e-3.
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& rounded);

// Says why a matrix is none, for an error about it.
const char* why_no_rotation(const Eigen::Matrix3d& matrix);

// Returns E with x_right^T E x_left = 0 for normalized undistorted points.
Eigen::Matrix3d essential_matrix(const StereoRig& rig);
// Returns F with u_right^T F u_left = 0 for undistorted pixels of the raw cameras; its Frobenius
// norm is 1.
Eigen::Matrix3d fundamental_matrix(const StereoRig& rig);

}  // namespace maploop::sensors
