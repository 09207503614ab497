// Earth-centred coordinates and the local frame: WGS84.
#pragma once

#include <Eigen/Core>

#include "msgs/local_frame.h"

namespace maploop::ppp {

inline constexpr double earth_rotation_rate = 7.2921151467e-5;  // rad/s

// Precondition: farther than 100 km from the earth's centre. To 0.1 mm near the surface.
Geodetic geodetic_from_ecef(const Eigen::Vector3d& p);
Eigen::Vector3d ecef_from_geodetic(const Geodetic& g);

// Rows are east, north and up: turns a vector of the earth-centred frame into the local one.
Eigen::Matrix3d rotation_enu_ecef(const Geodetic& g);

}  // namespace maploop::ppp
