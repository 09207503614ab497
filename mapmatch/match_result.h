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

// A MatchResult adds time and place to what the matcher decides about a fix.
struct MatchResult : LinkMatch {
  Time stamp{};     // of the last fix that was not refused
  LinkPoint point;  // matched position and direction, valid if on_road
};

}  // namespace maploop::mapmatch
