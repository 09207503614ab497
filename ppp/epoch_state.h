// Converts the filter's solution of an epoch to the vehicle's messages.
#pragma once

#include "msgs/gnss.h"
#include "msgs/ppp_state.h"
#include "ppp/filter/map_aided_filter.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// Fills `state` from the solution and reuses its memory. The sample's times and the fields of the
// map and of corrections stay as they are. The protection levels (m) are for `integrity_risk`, a
// probability in (0, 1).
void describe(const PppSolution& solution, double integrity_risk, PppState& state);

// Fills what the map has contributed to the solution: whether it aids, and how many roads were used
// or refused.
void describe_map(const MapAidedFilter& filter, PppState& state);

// Returns position and velocity. Precondition: the state has them (its status is not none).
GnssFix to_fix(const PppState& state);

}  // namespace maploop::ppp
