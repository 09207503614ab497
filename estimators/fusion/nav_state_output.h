// The filter's state is converted here to the messages that other parts of the system read.
#pragma once

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"
#include "msgs/odom_state.h"

namespace maploop::fusion {

// Returns the derivative of position (enu, m), velocity (enu, m/s), azimuth, pitch and roll (rad)
// with respect to the state.
Eigen::Matrix<double, 9, index::count> nav_state_jacobian(const FilterState& state);

// Fills in status, stamps and covariance too. The side slip is not a state, so its variance is
// added to the velocity's. `available` equals the stamp; the caller may change `available` and
// `sequence`.
NavState nav_state(const FilterState& state, const Geodetic& origin,
                   const FusionParameters& parameters);

// Adds the pose in the frame of odometry.
FusedState fused_state(const FilterState& state, const Geodetic& origin,
                       const FusionParameters& parameters);

// Returns what a fix that is too slow to show a direction says of the vehicle at `t`, which is not
// before the fix: its position and velocity. The azimuth is unknown, so that the antenna may be on
// any side of the vehicle. The frame of odometry has not begun.
FusedState state_without_course(const GnssFix& fix, Time t, const LocalFrame& frame,
                                const FusionParameters& parameters);

}  // namespace maploop::fusion
