#include "estimators/stereo/triangulate.h"

namespace maploop::stereo {

Eigen::Vector3d triangulate(const StereoCalibration& camera, const ImagePoint& image) {
  const double z = camera.fx * camera.baseline / image.z();  // (2) of METHOD.md
  return {(image.x() - camera.cx) * z / camera.fx, (image.y() - camera.cy) * z / camera.fy, z};
}

Eigen::Vector3d triangulate_by_disparity(const Eigen::Vector3d& p_cam, double disparity) {
  return -p_cam / disparity;
}

double depth_sigma(const StereoCalibration& camera, double depth, double sigma_disparity) {
  return depth * depth * sigma_disparity / (camera.fx * camera.baseline);
}

ImagePoint project(const StereoCalibration& camera, const Eigen::Vector3d& p_cam) {
  const double inverse_z = 1.0 / p_cam.z();
  return {camera.fx * p_cam.x() * inverse_z + camera.cx,
          camera.fy * p_cam.y() * inverse_z + camera.cy, camera.fx * camera.baseline * inverse_z};
}

Eigen::Matrix3d project_jacobian(const StereoCalibration& camera, const Eigen::Vector3d& p_cam) {
  const double inverse_z = 1.0 / p_cam.z();
  const double fx = camera.fx * inverse_z;
  const double fy = camera.fy * inverse_z;
  Eigen::Matrix3d jacobian;
  jacobian << fx, 0.0, -fx * p_cam.x() * inverse_z,  //
      0.0, fy, -fy * p_cam.y() * inverse_z,          //
      0.0, 0.0, -fx * camera.baseline * inverse_z;
  return jacobian;
}

}  // namespace maploop::stereo
