// Draws what the map matcher decided about one state, for viewers in three dimensions.
#pragma once

#include <maploop_lcm/map_match_t.hpp>

#include "tools/log/foxglove_schemas.h"

namespace maploop::lcm_log {

// Returns the ellipse of 3 standard deviations of the state's position; if the vehicle is on a
// road, its middle and its edges from 15 m behind the matched point to 15 m ahead, bent as the
// message says; and the most likely candidates with their probabilities as text. The frame is
// "body_enu": its origin is the body, and its axes are east, north and up.
foxglove::SceneUpdate match_scene(const maploop_lcm::map_match_t& match);

}  // namespace maploop::lcm_log
