// These functions give the mechanization normal gravity, radii of curvature and Earth rotation
// (WGS84).
#pragma once

#include <Eigen/Core>

#include "msgs/local_frame.h"

namespace maploop::fusion {

// Returns normal gravity in m/s^2. The latitude is in rad, the height in m above the ellipsoid.
double normal_gravity(double latitude, double height);

double prime_vertical_radius(double latitude);  // R_N, m, latitude in rad: east-west curvature
double meridian_radius(double latitude);        // R_M, m, latitude in rad: north-south curvature

// Describes the Earth in a local enu frame. The frame is fixed to the Earth, so an azimuth measured
// from north at the origin is affected by the Earth rate but not by the transport rate. The
// transport rate is the rotation of local north as the vehicle moves; here it appears as the change
// of the plumb line with position.
class LocalEarth {
 public:
  explicit LocalEarth(const Geodetic& origin);

  double earth_rate_up() const { return earth_rate_.z(); }           // rad/s about the origin's up
  const Eigen::Vector3d& earth_rate() const { return earth_rate_; }  // rad/s, enu at the origin
  double gravity(double up) const;  // m/s^2 at height `up` in the frame
  // Returns the local vertical in enu at a position (m), to first order in the distance from the
  // origin.
  Eigen::Vector3d vertical(double east, double north) const {
    return {east * curvature_.x(), north * curvature_.y(), 1.0};
  }
  // Returns the derivative of the vertical in 1/m: x with respect to east, y with respect to north.
  const Eigen::Vector2d& curvature() const { return curvature_; }

 private:
  double latitude_;
  double height_;
  Eigen::Vector3d earth_rate_;
  Eigen::Vector2d curvature_;
};

}  // namespace maploop::fusion
