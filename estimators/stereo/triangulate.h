// These functions are the geometry of a rectified stereo pair.
#pragma once

#include <Eigen/Core>

#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// This is what a rectified pair measures of a point: u, v in the left image, and the disparity, px.
using ImagePoint = Eigen::Vector3d;

inline ImagePoint image_of(const StereoObservation& seen) {
  return {seen.u_left, seen.v_left, seen.disparity()};
}

// Returns the point in cam, m: Z = fx B / d, X = (u - cx) Z / fx, Y = (v - cy) Z / fy. Disparity >
// 0.
Eigen::Vector3d triangulate(const StereoCalibration& camera, const ImagePoint& image);

// Returns its derivative with respect to the disparity, -p_cam / d.
Eigen::Vector3d triangulate_by_disparity(const Eigen::Vector3d& p_cam, double disparity);

// Returns the standard deviation of Z, Z^2 sigma_d / (fx B), m.
double depth_sigma(const StereoCalibration& camera, double depth, double sigma_disparity);

// Returns the inverse of triangulate. Z > 0.
ImagePoint project(const StereoCalibration& camera, const Eigen::Vector3d& p_cam);

// Returns the derivative of project with respect to p_cam.
Eigen::Matrix3d project_jacobian(const StereoCalibration& camera, const Eigen::Vector3d& p_cam);

}  // namespace maploop::stereo
