// Geometry of a rectified stereo pair.
#pragma once

#include <Eigen/Core>

#include "msgs/calibration.h"

namespace maploop::stereo {

// What a rectified pair measures of a point: u, v in the left image and the disparity, px.
using ImagePoint = Eigen::Vector3d;

// Point in cam: Z = fx B / d, X = (u - cx) Z / fx, Y = (v - cy) Z / fy. Disparity > 0.
Eigen::Vector3d triangulate(const StereoCalibration& camera, const ImagePoint& image);

// Its derivative by the disparity: -p_cam / d.
Eigen::Vector3d triangulate_by_disparity(const Eigen::Vector3d& p_cam, double disparity);

// Standard deviation of Z: Z^2 sigma_d / (fx B), m.
double depth_sigma(const StereoCalibration& camera, double depth, double sigma_disparity);

// Inverse of triangulate. Z > 0.
ImagePoint project(const StereoCalibration& camera, const Eigen::Vector3d& p_cam);

// Derivative of project by p_cam.
Eigen::Matrix3d project_jacobian(const StereoCalibration& camera, const Eigen::Vector3d& p_cam);

}  // namespace maploop::stereo
