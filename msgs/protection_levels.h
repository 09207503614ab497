// Computes how wrong a position may be: protection levels from its covariance.
#pragma once

#include <Eigen/Core>

namespace maploop {

// An error along, across or up lies beyond its level with a stated probability.
struct ProtectionLevels {
  double along = 0.0, across = 0.0, up = 0.0;  // m

  void archive(auto& ar) { ar(along, across, up); }
};

// Returns the factor k for which a normally distributed error exceeds k standard deviations, on
// either side, with this probability. `risk` is in (0, 1).
double integrity_factor(double risk);

// Computes the levels (m) along and across the direction of travel, and up. For a vehicle that
// stands (below 0.5 m/s), both horizontal levels are those of the largest axis of the horizontal
// plane. The covariance (m^2) is in the order east, north, up.
ProtectionLevels protection_levels(const Eigen::Matrix3d& covariance_enu,
                                   const Eigen::Vector3d& velocity_enu, double factor);

// These are unit vectors along and across (to the right of) the direction of travel. If the vehicle
// stands, it has no direction: they are east and north, and `known` is false.
struct TravelAxes {
  Eigen::Vector2d along, across;  // east, north
  bool known;                     // whether the vehicle moves
};
// Returns the axes of a velocity (m/s).
TravelAxes travel_axes(const Eigen::Vector3d& velocity_enu);

}  // namespace maploop
