// A PPP state is converted here to a fix for the matcher.
#pragma once

#include "mapmatch/vehicle_fix.h"
#include "msgs/ppp_state.h"

namespace maploop::mapmatch {

// Returns position, speed and, if the vehicle moves, the direction of travel as azimuth. The state
// must have a position.
VehicleFix fix_of(const PppState& state);

}  // namespace maploop::mapmatch
