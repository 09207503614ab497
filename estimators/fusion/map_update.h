// The road that map matching has found corrects position and azimuth.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/local_frame.h"
#include "msgs/map_feedback.h"

namespace maploop::fusion {

// z = 0; h = n (p - m) - sigma_lane b, in m, where n points to the right of the line through m and
// b is the lane offset in units of its own standard deviation. Only the position across the line is
// corrected: along it a projection adds no information. After a turn the former along-road
// direction lies across the new road.
Innovation<1> line_innovation(const FilterState& state, const MapFeedback& feedback,
                              const LocalFrame& frame);
// z = azimuth of the link, rad; h = azimuth.
Innovation<1> link_azimuth_innovation(const FilterState& state, const MapFeedback& feedback);

// Enters another road: only the lasting share of the lane offset is kept, the remaining part is
// unknown.
void enter_road(FilterState& state, const FusionParameters& parameters);

Reason check_feedback(const MapFeedback& feedback, const FusionParameters& parameters);

// Applies azimuth and position, each with its own gate. The outcome is that of the position if the
// feedback has one. A hard reset is not gated: the state takes the matched position and azimuth
// with the feedback's sigmas.
Outcome apply_map(FilterState& state, const MapFeedback& feedback, const LocalFrame& frame,
                  const FusionParameters& parameters);

}  // namespace maploop::fusion
