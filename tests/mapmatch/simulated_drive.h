// This drive along a line of places is input for the matcher.
#pragma once

#include <vector>

#include "mapmatch/vehicle_fix.h"

namespace maploop::testing {

// Returns a drive from place to place (metres east and north of SmallMap's origin) at a constant
// speed (m/s), with a fix every 1/rate s that has speed and azimuth and is offset to the right by
// `right` metres.
std::vector<mapmatch::VehicleFix> drive(const std::vector<Eigen::Vector2d>& places, double speed,
                                        double rate, double right = 0.0);

}  // namespace maploop::testing
