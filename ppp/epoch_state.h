// The filter's solution of an epoch as what the vehicle says of it.
#pragma once

#include "msgs/gnss.h"
#include "msgs/ppp_state.h"
#include "ppp/filter/map_aided_filter.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// Everything but the sample's own times; reuses the memory of `state`. Protection
// levels are for this integrity risk.
void describe(const PppSolution& solution, double integrity_risk, PppState& state);

// What the map has done for its solution.
void describe_map(const MapAidedFilter& filter, PppState& state);

// Position and velocity of a state that has them.
GnssFix to_fix(const PppState& state);

}  // namespace maploop::ppp
