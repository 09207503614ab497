// The filter's state as the rest of the system reads it.
#pragma once

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "msgs/nav_state.h"

namespace maploop::fusion {

// Derivative of position, velocity (enu), azimuth, pitch and roll by the state.
Eigen::Matrix<double, 9, index::count> nav_state_jacobian(const StateVector& x);

// Status, stamps and covariance included; to the velocity's, the side slip is added that the state
// does not hold. `available` is the stamp; both it and `sequence` are the caller's to change.
NavState nav_state(const FilterState& state, const Geodetic& origin,
                   const FusionParameters& parameters);

}  // namespace maploop::fusion
