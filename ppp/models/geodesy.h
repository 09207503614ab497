// Converts between earth-centred coordinates and the local frame (WGS84).
#pragma once

#include <Eigen/Core>

#include "msgs/local_frame.h"

namespace maploop::ppp {

inline constexpr double earth_rotation_rate = 7.2921151467e-5;  // rad/s

// Precondition: the point is farther than 100 km from the earth's centre. The result is accurate to
// 0.1 mm near the surface.
Geodetic geodetic_from_ecef(const Eigen::Vector3d& p);
Eigen::Vector3d ecef_from_geodetic(const Geodetic& g);

// Returns the rotation of earth-centred vectors into the local frame; its rows are east, north and
// up.
Eigen::Matrix3d rotation_enu_ecef(const Geodetic& g);

}  // namespace maploop::ppp
