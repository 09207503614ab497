// How far a position may be wrong: protection levels from its covariance.
#pragma once

#include <Eigen/Core>

#include "msgs/ppp_state.h"

namespace maploop::ppp {

// The factor on a standard deviation that a normal error exceeds, on either side, with this
// probability; risk in (0, 1).
double integrity_factor(double risk);

// Along and across the direction of travel; of a vehicle that stands (below 0.5 m/s) both are the
// largest of the horizontal plane. The covariance is of east, north, up.
ProtectionLevels protection_levels(const Eigen::Matrix3d& covariance_enu,
                                   const Eigen::Vector3d& velocity_enu, double factor);

// Unit vectors of the same directions; nothing to choose from when it stands: east and north.
struct TravelAxes {
  Eigen::Vector2d along, across;  // east, north
  bool known;
};
TravelAxes travel_axes(const Eigen::Vector3d& velocity_enu);

}  // namespace maploop::ppp
