// Why a link was chosen or not, in words. For people: these allocate.
#pragma once

#include <string>
#include <vector>

#include "mapmatch/match_result.h"
#include "mapmatch/rule_bases.h"

namespace maploop::mapmatch {

// "azimuth differs by 47 degrees", "31 m away", "no legal turn leads there": what speaks against a
// candidate; empty where nothing does.
std::vector<std::string> objections(const MatchCandidate& candidate, const RoadNetwork& network);

// The rules that applied to it, the weightiest first, with their weights.
std::vector<std::pair<std::string, double>> fired_rules(const MatchCandidate& candidate,
                                                        const RuleBases& rules);

// A sentence on the result: the link and why it, or why none.
std::string explanation(const LinkMatch& match, const RoadNetwork& network);

// All of it. Of a match of this network by these rules.
MapMatchWords in_words(const LinkMatch& match, const RoadNetwork& network, const RuleBases& rules);

}  // namespace maploop::mapmatch
