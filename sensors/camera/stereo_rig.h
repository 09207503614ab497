// Two raw cameras, how they stand to each other, and how their images are rectified.
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

  // Raw to rectified camera.
  Eigen::Matrix3d R_rect_left = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_rect_right = Eigen::Matrix3d::Identity();
  StereoCalibration rectified;  // T_body_cam is not set: see mounted()

  // Where the raw left camera sits, if that is known.
  std::optional<Eigen::Isometry3d> T_body_left;
};

// The rectified pair, of a raw left camera that sits there.
StereoCalibration mounted(const StereoRig& rig, const Eigen::Isometry3d& T_body_left);

// What is wrong with it, or nothing: sizes, focal lengths, a distortion that turns back in most of
// the image, rotations that are none (to 1e-6), a rectification that does not fit the extrinsics
// (rows apart by more than half a pixel at the far corners, or another baseline).
std::optional<std::string> problem_of(const StereoRig& rig);

// x_right^T E x_left = 0 for normalized undistorted points.
Eigen::Matrix3d essential_matrix(const StereoRig& rig);
// u_right^T F u_left = 0 for undistorted pixels of the raw cameras; of Frobenius norm 1.
Eigen::Matrix3d fundamental_matrix(const StereoRig& rig);

}  // namespace maploop::sensors
