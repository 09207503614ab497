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

struct MatchResult : LinkMatch {
  Time stamp{};
  LinkPoint point;  // matched position and direction, valid if on_road
};

}  // namespace maploop::mapmatch
