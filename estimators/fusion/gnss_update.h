// Correction by a GNSS receiver's position and velocity, loosely coupled.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"

namespace maploop::fusion {

// z = position in enu; h = position + R lever + L offset, where the offset is what lasts of the
// receiver's error, of variance 1 and with L L^T the lasting share of the stated covariance; R has
// the rest (fix_error.h).
Innovation<3> position_innovation(const FilterState& state, const GnssFix& fix,
                                  const LocalFrame& frame, const FusionParameters& parameters);

// z = velocity in enu; h = speed along the direction of travel + R (rate x lever). Side slip, which
// the state does not hold, is in R.
Innovation<3> velocity_innovation(const FilterState& state, const GnssFix& fix, double yaw_rate,
                                  const FusionParameters& parameters);

// At the fix's two stamps. A position gated `gnss_recover_after` times in a row makes the filter
// doubt itself (`recoveries`), and twice as many make it begin anew at the fix
// (`reinitializations`), with the biases and scales that it knows.
Outcome apply_gnss_position(FilterState& state, const GnssFix& fix, const LocalFrame& frame,
                            const FusionParameters& parameters);
Outcome apply_gnss_velocity(FilterState& state, const GnssFix& fix, double yaw_rate,
                            const FusionParameters& parameters);

// Whether a velocity known to a fifth of `recovery_speed_sigma` was applied within the last
// `fix_hold`: it has confirmed the predicted speed, and what contradicts that is wrong itself.
bool held_by_fix(const FilterState& state, const FusionParameters& parameters);

}  // namespace maploop::fusion
