#include "sensors/camera/stereo_rig.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace maploop::sensors {
namespace {

bool is_size(int side) {
  return side >= 16 && side <= 16384;
}

bool is_focal_length(double f) {
  return f >= 1.0 && f <= 1e5;
}

bool is_centre(double c, int side) {
  return c > -side && c < 2.0 * side;
}

bool is_rotation(const Eigen::Matrix3d& r, double tolerance = 1e-6) {
  return (r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < tolerance &&
         r.determinant() > 0.0;
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d camera_matrix(const CameraModel& camera) {
  Eigen::Matrix3d k;
  k << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0;
  return k;
}

std::optional<std::string> problem_of(const CameraModel& camera, const std::string& name,
                                      const StereoRig& rig) {
  if (!is_focal_length(camera.fx) || !is_focal_length(camera.fy))
    return "the " + name + " camera's focal length is not 1 to 100000 pixels";
  if (!is_centre(camera.cx, rig.width) || !is_centre(camera.cy, rig.height))
    return "the " + name + " camera's principal point is far outside of the image";
  try {
    reversed(camera, rig.width, rig.height);
  } catch (const std::runtime_error& error) {
    return "the " + name + " camera: " + error.what();
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> problem_of(const StereoRig& rig) {
  const StereoCalibration& r = rig.rectified;
  if (!is_size(rig.width) || !is_size(rig.height) || !is_size(r.width) || !is_size(r.height))
    return "an image size is not 16 to 16384 pixels";
  if (auto problem = problem_of(rig.left, "left", rig)) return problem;
  if (auto problem = problem_of(rig.right, "right", rig)) return problem;
  if (!is_focal_length(r.fx) || !is_focal_length(r.fy))
    return "the rectified focal length is not 1 to 100000 pixels";
  if (!is_centre(r.cx, r.width) || !is_centre(r.cy, r.height))
    return "the rectified principal point is far outside of the image";
  if (!(r.baseline > 0.01 && r.baseline < 10.0)) {
    return "the baseline is " + std::to_string(r.baseline) +
           " m, outside 0.01 to 10 m (are left and right swapped?)";
  }
  for (const Eigen::Matrix3d& m :
       {rig.R_rect_left, rig.R_rect_right, Eigen::Matrix3d(rig.T_right_left.linear())})
    if (!is_rotation(m)) return "a matrix that should be a rotation is not one";
  if (rig.T_body_left && !is_rotation(rig.T_body_left->linear()))
    return "the camera's mounting is not a rotation";

  // After rectification the cameras are parallel, and the right one is `baseline` along +x.
  const Eigen::Matrix3d turned =
      rig.R_rect_right * rig.T_right_left.linear() * rig.R_rect_left.transpose();
  const Eigen::Vector3d right = -rig.R_rect_right * rig.T_right_left.translation();
  const double half_pixel = 0.5 / std::hypot(r.fx, r.width, r.height);  // rad, any direction
  if ((turned - Eigen::Matrix3d::Identity()).norm() > half_pixel ||
      (right / r.baseline - Eigen::Vector3d::UnitX()).norm() > std::max(half_pixel, 1e-3))
    return "the rectification does not fit the extrinsics";
  return std::nullopt;
}

StereoCalibration mounted(const StereoRig& rig, const Eigen::Isometry3d& T_body_left) {
  StereoCalibration calibration = rig.rectified;
  calibration.T_body_cam = T_body_left * Eigen::Isometry3d(rig.R_rect_left.transpose());
  return calibration;
}

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& rounded) {
  if (!is_rotation(rounded, 1e-3)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rounded, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

const char* why_no_rotation(const Eigen::Matrix3d& matrix) {
  if (!(matrix.determinant() < 0.0)) return "is not a rotation matrix";
  return "is not a rotation but mirrored (its determinant is negative): has an axis the wrong "
         "sign, "
         "or are two of them exchanged?";
}

Eigen::Matrix3d essential_matrix(const StereoRig& rig) {
  return cross(rig.T_right_left.translation()) * rig.T_right_left.linear();
}

Eigen::Matrix3d fundamental_matrix(const StereoRig& rig) {
  const Eigen::Matrix3d f = camera_matrix(rig.right).inverse().transpose() * essential_matrix(rig) *
                            camera_matrix(rig.left).inverse();
  return f / f.norm();
}

}  // namespace maploop::sensors
