// The position and velocity of a GNSS receiver correct the state (loosely coupled).
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"

namespace maploop::fusion {

// z = position in enu, m; h = position + R lever + L offset. The offset is the lasting part of the
// receiver's error with variance 1, and L L^T is the lasting share of the stated covariance. R
// contains the remaining share (fix_error.h). With an increment, z and R are the increment's, and L
// is zero.
Innovation<3> position_innovation(const FilterState& state, const GnssFix& fix,
                                  const LocalFrame& frame, const FusionParameters& parameters);

// z = velocity in enu, m/s; h = speed along the direction of travel + R (rate x lever), with
// `yaw_rate` in rad/s. The side slip is not a state, so its variance is in R. With an increment, z
// and the rest of R are the increment's.
Innovation<3> velocity_innovation(const FilterState& state, const GnssFix& fix, double yaw_rate,
                                  const FusionParameters& parameters);

// These apply a fix's position and velocity, each at its own stamp. After `gnss_recover_after`
// consecutive gated positions the position covariance is inflated (`recoveries`). After twice as
// many the filter restarts from the fix (`reinitializations`) and keeps its estimates of biases and
// scales. After `gnss_recover_after` consecutive gated velocities the azimuth is doubted.
Outcome apply_gnss_position(FilterState& state, const GnssFix& fix, const LocalFrame& frame,
                            const FusionParameters& parameters);
Outcome apply_gnss_velocity(FilterState& state, const GnssFix& fix, double yaw_rate,
                            const FusionParameters& parameters);

// Returns whether a velocity with a sigma of at most a fifth of `recovery_speed_sigma` was applied
// within the last `fix_hold`. It has confirmed the predicted speed, so a measurement that
// contradicts this speed is itself wrong.
bool held_by_fix(const FilterState& state, const FusionParameters& parameters);

}  // namespace maploop::fusion
