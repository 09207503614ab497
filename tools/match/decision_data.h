// Gathers what the page of a matched track says about each decision.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "mapmatch/rule_bases.h"
#include "tools/match/match_output.h"

namespace maploop::match {

// Returns the places of these fixes and of their matches, the candidates with the reasons in words,
// and the roads around them (tools/web/src/match.ts). Each different sentence is stored once.
nlohmann::json decision_data(const MatchedTrack& track, const mapmatch::RoadNetwork& network,
                             const mapmatch::RuleBases& rules);

}  // namespace maploop::match
