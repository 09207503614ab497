// The Earth as the mechanization needs it: normal gravity, radii of curvature, rotation
// (WGS84).
#pragma once

#include <Eigen/Core>

#include "msgs/local_frame.h"

namespace maploop::fusion {

// m/s^2; latitude in rad, height in m above the ellipsoid.
double normal_gravity(double latitude, double height);

double prime_vertical_radius(double latitude);  // R_N, m: curvature east-west
double meridian_radius(double latitude);        // R_M, m: curvature north-south

// The Earth seen from a local frame. The frame is fixed to the Earth, so an azimuth counted from
// the origin's north feels the Earth rate but no transport rate: that one is the turning of the
// local north with the vehicle, and appears here as the turning of the plumb line with position.
class LocalEarth {
 public:
  explicit LocalEarth(const Geodetic& origin);

  double earth_rate_up() const { return earth_rate_up_; }  // rad/s about the origin's up
  double gravity(double up) const;                         // m/s^2 at height `up` in the frame
  // The local vertical at a position in enu, to first order in its distance from the origin.
  Eigen::Vector3d vertical(double east, double north) const {
    return {east * curvature_.x(), north * curvature_.y(), 1.0};
  }
  // Derivative of the vertical: x by east, y by north, 1/m.
  const Eigen::Vector2d& curvature() const { return curvature_; }

 private:
  double latitude_;
  double height_;
  double earth_rate_up_;
  Eigen::Vector2d curvature_;
};

}  // namespace maploop::fusion
