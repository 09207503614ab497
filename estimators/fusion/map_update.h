// Correction by the road that the map matching has found.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/local_frame.h"
#include "msgs/map_feedback.h"

namespace maploop::fusion {

// z = 0; h = n (p - m) - sigma_lane b, with n to the right of the line through m and b the lane
// offset in units of its own standard deviation. Across the line alone: along it a projection says
// nothing that the filter did not say before. A turn makes the one direction the other.
Innovation<1> line_innovation(const FilterState& state, const MapFeedback& feedback,
                              const LocalFrame& frame);
// z = azimuth of the link; h = azimuth.
Innovation<1> link_azimuth_innovation(const FilterState& state, const MapFeedback& feedback);

// Another road: what was the lane offset is one of another road but for the share that lasts.
void enter_road(FilterState& state, const FusionParameters& parameters);

Reason check_feedback(const MapFeedback& feedback, const FusionParameters& parameters);

// Gated, the azimuth by itself; the outcome is the position's where there is one. A hard reset is
// not gated: the state becomes the matched place and azimuth, known as well as the feedback says.
Outcome apply_map(FilterState& state, const MapFeedback& feedback, const LocalFrame& frame,
                  const FusionParameters& parameters);

}  // namespace maploop::fusion
