// Correction by the wheels' speed.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// z = speed of the wheels; h = speed.
Innovation<1> wheel_innovation(const FilterState& state, const WheelSpeed& sample,
                               const FusionParameters& parameters);

// After `recover_after` gated samples in a row the prediction is the suspect (`recoveries`), unless
// a fix has just confirmed it (held_by_fix).
Outcome apply_wheel(FilterState& state, const WheelSpeed& sample,
                    const FusionParameters& parameters);

}  // namespace maploop::fusion
