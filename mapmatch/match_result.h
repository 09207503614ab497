// This is the matcher's result for a fix.
#pragma once

#include "mapmatch/road_network.h"
#include "mapmatch/vehicle_fix.h"
#include "msgs/map_match.h"

namespace maploop::mapmatch {

using maploop::FixRefusal;
using maploop::MatchCandidate;
using maploop::MatchPhase;
using maploop::RuleBase;

// P(off road) from which the vehicle may have left the roads of the map.
inline constexpr double may_have_left = 0.1;

// A MatchResult adds time and place to what the matcher decides about a fix.
struct MatchResult : LinkMatch {
  Time stamp{};     // of the last fix that was not refused
  LinkPoint point;  // matched position and direction, valid if on_road
};

}  // namespace maploop::mapmatch
