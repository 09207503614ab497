// One event of the history is applied here to the state before it.
#pragma once

#include "estimators/fusion/earth.h"
#include "estimators/fusion/event_history.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/inertial_input.h"
#include "msgs/local_frame.h"

namespace maploop::fusion {

// Predicts the state to `to` with the samples around its stamp, one stretch after another.
void advance(FilterState& state, const InertialSamples& samples, Time to, const LocalEarth& earth,
             const FusionParameters& parameters);

// Applies the event's measurement; `samples` are those around it, of which `before` is older than
// the event. Precondition: state.stamp == event.key.stamp.
Outcome apply_event(FilterState& state, const Event& event, const InertialSamples& samples,
                    const LocalFrame& frame, const LocalEarth& earth,
                    const FusionParameters& parameters);

}  // namespace maploop::fusion
