// This file defines the drive's local east-north-up frame: metric WGS84, tangent at an origin.
#pragma once

#include <Eigen/Core>

namespace maploop {

struct Geodetic {
  double latitude = 0.0;   // rad, WGS84
  double longitude = 0.0;  // rad
  double height = 0.0;     // m above the ellipsoid

  bool operator==(const Geodetic&) const = default;
  void archive(auto& ar) { ar(latitude, longitude, height); }
};

class LocalFrame {
 public:
  LocalFrame() = default;
  explicit LocalFrame(const Geodetic& origin) : origin_(origin) {}

  const Geodetic& origin() const { return origin_; }
  Eigen::Vector3d to_enu(const Geodetic& point) const;
  Geodetic to_geodetic(const Eigen::Vector3d& p_enu) const;

 private:
  Geodetic origin_;
};

}  // namespace maploop
