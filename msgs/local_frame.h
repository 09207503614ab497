// This file defines the drive's local east-north-up frame: metric WGS84, tangent at an origin.
#pragma once

#include <Eigen/Core>

namespace maploop {

// This is a position on the earth.
struct Geodetic {
  double latitude = 0.0;   // rad, WGS84
  double longitude = 0.0;  // rad
  double height = 0.0;     // m above the ellipsoid

  bool operator==(const Geodetic&) const = default;  // exact
  void archive(auto& ar) { ar(latitude, longitude, height); }
};

// Converts between geodetic positions and coordinates in the east-north-up frame of an origin. It
// does not change, so that any thread may use it.
class LocalFrame {
 public:
  LocalFrame() = default;  // the origin has latitude, longitude and height 0
  // Makes the frame that is tangent to the ellipsoid at `origin`.
  explicit LocalFrame(const Geodetic& origin) : origin_(origin) {}

  const Geodetic& origin() const { return origin_; }  // where enu is zero
  // Returns the coordinates of a point: m, x east, y north, z up.
  Eigen::Vector3d to_enu(const Geodetic& point) const;
  // Does the reverse.
  Geodetic to_geodetic(const Eigen::Vector3d& p_enu) const;

 private:
  Geodetic origin_;
};

}  // namespace maploop
