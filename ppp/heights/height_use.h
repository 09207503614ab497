// This states whether the height of the ground was used at an epoch, or why it was not.
#pragma once

#include <cstdint>

#include "msgs/named_enum.h"

namespace maploop::ppp {

enum class HeightUse : std::uint8_t {
  used,
  not_asked,   // no model was given, or there is no position
  no_tile,     // neither the tiles nor the geoid's grid contain the place
  no_height,   // the tile is void there
  unreadable,  // the tile is damaged
  off_ground,  // the road that is driven is a bridge, in a tunnel or on another level
  gated,       // it is too far from the filter's height
};

constexpr auto names_of(HeightUse) {
  return names_up_to<HeightUse::gated>(
      {"used", "no position", "outside the tiles", "void in the tile", "tile not readable",
       "on a bridge, in a tunnel or on another level", "too far from the filter's height"});
}

}  // namespace maploop::ppp
