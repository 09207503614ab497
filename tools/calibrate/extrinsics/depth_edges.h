// This file finds where a scan jumps from a near object to what is behind it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimators/lidar/scan_preparation.h"

namespace maploop::extrinsics {

// Returns the outermost points of near objects to the left and right of which the scan jumps by at
// least 0.6 m and 5 % of the range, such as those of poles, trunks and corners of cars and houses;
// in the scanner's axes at the scan's stamp, if it moves by `motion` meanwhile. Points are compared
// in a grid of 0.35 degrees of azimuth and 0.4 of elevation, from 3 to 50 m, so that their order
// does not matter. `elevation` (rad) is added to that of all points.
std::vector<Eigen::Vector3f> depth_edges(const lidar::ScanView& scan, const lidar::Twist& motion,
                                         double elevation);

}  // namespace maploop::extrinsics
