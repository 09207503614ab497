// What of a PPP state matters to the matcher.
#pragma once

#include "mapmatch/vehicle_fix.h"
#include "msgs/ppp_state.h"

namespace maploop::mapmatch {

// Position, speed and, of one that moves, the direction of travel for the azimuth. Of a state that
// has a position.
VehicleFix fix_of(const PppState& state);

}  // namespace maploop::mapmatch
