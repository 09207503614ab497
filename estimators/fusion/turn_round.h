// The heading of a vehicle that was taken to drive forward while it drove in reverse.
#pragma once

#include "estimators/fusion/filter_state.h"

namespace maploop::fusion {

// Turns the vehicle's front to where its rear was assumed. Its path stays the same.
void turn_round(FilterState& state);

}  // namespace maploop::fusion
