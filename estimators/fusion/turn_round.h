// The heading of a vehicle that was taken to drive forward while it drove in reverse.
#pragma once

#include "estimators/fusion/filter_state.h"

namespace maploop::fusion {

// Turns the vehicle's front to where its rear was assumed. Its path stays the same, so that the
// speed changes its sign.
void turn_round(FilterState& state);

// Turns only the heading: the speed's sign and the motion in the frame of odometry were right.
void turn_heading(FilterState& state);

}  // namespace maploop::fusion
