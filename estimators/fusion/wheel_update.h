// The speed of the wheels corrects the state.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// z = speed of the wheels, m/s; h = speed.
Innovation<1> wheel_innovation(const FilterState& state, const WheelSpeed& sample,
                               const FusionParameters& parameters);

// After each `recover_after` consecutive gated samples the speed's covariance is inflated
// (`recoveries`), unless a fix has just confirmed the speed (held_by_fix). Wheels that fixes have
// shown to be wrong (WheelCheck) are refused.
Outcome apply_wheel(FilterState& state, const WheelSpeed& sample,
                    const FusionParameters& parameters);

}  // namespace maploop::fusion
