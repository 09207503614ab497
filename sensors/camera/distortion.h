// This file describes how a lens bends rays.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "msgs/named_enum.h"

namespace maploop::sensors {

enum class Lens : std::uint8_t { radial_tangential, equidistant };

constexpr auto names_of(Lens) {
  return names_up_to<Lens::equidistant>({"radial-tangential", "equidistant"});
}

// The coefficients act on normalized image coordinates (at unit depth), with r^2 = x^2 + y^2.
// Radial-tangential is the polynomial of Brown (1966), with k4, k5 and k6 the rational one of
// OpenCV (rational_polynomial of ROS):
//   c = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
//   x' = x c + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y c + p1 (r^2 + 2 y^2) + 2 p2 x y
// Equidistant is that of Kannala and Brandt (2006) for wide lenses (equidistant of Kalibr and ROS,
// OpenCV's fisheye); it uses k1 to k4 and the ray's angle a = atan(r):
//   x' = x d / r,  y' = y d / r,  d = a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8)
// OpenCV, ROS (plumb_bob), Kalibr (radtan), KITTI and this project apply it from undistorted to
// distorted; photogrammetry applies it from distorted to undistorted. The coefficients of one
// direction are not those of the other: see reversed() of camera_model.h.
struct Distortion {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;  // in OpenCV's order
  double k4 = 0.0, k5 = 0.0, k6 = 0.0;
  Lens lens = Lens::radial_tangential;
};

struct DistortedPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d by_point;
};

// Evaluates the lens and its derivatives at the normalized point `x`.
DistortedPoint apply(const Distortion& distortion, const Eigen::Vector2d& x);

// Returns the derivatives of a distorted point by k1, k2, p1, p2 and k3 of Brown's polynomial,
// which do not depend on their values.
Eigen::Matrix<double, 2, 5> by_coefficients(const Eigen::Vector2d& x);

// Returns whether the distorted radius grows all the way from the axis to `x`. Far outside of the
// image a polynomial turns back, and would show a second time what is already visible.
bool is_lens(const Distortion& distortion, const Eigen::Vector2d& x);

// Returns the coefficients that map `from` to `to` best, by linear least squares over at least
// three normalized points.
Distortion fit_distortion(const std::vector<Eigen::Vector2d>& from,
                          const std::vector<Eigen::Vector2d>& to);

}  // namespace maploop::sensors
