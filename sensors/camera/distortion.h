// This file describes a lens by three radial and two tangential coefficients.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace maploop::sensors {

// This is the polynomial of Brown (1966) on normalized image coordinates (at unit depth), with
// r^2 = x^2 + y^2:
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
// OpenCV, ROS (plumb_bob), Kalibr (radtan), KITTI and this project apply it from undistorted to
// distorted; photogrammetry applies it from distorted to undistorted. The coefficients of one
// direction are not those of the other: see reversed() of camera_model.h.
struct Distortion {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  // in OpenCV's order
};

struct DistortedPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d by_point;
  Eigen::Matrix<double, 2, 5> by_coefficients;  // k1 k2 p1 p2 k3; independent of their values
};

// Evaluates the polynomial and its derivatives at the normalized point `x`.
DistortedPoint apply(const Distortion& distortion, const Eigen::Vector2d& x);

// Returns the coefficients that map `from` to `to` best, by linear least squares over at least
// three normalized points.
Distortion fit_distortion(const std::vector<Eigen::Vector2d>& from,
                          const std::vector<Eigen::Vector2d>& to);

}  // namespace maploop::sensors
