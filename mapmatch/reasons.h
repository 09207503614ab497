// These functions explain in words why a link was chosen or not, and what a drive contradicts. They
// are for display and allocate.
#pragma once

#include <string>
#include <vector>

#include "mapmatch/match_result.h"
#include "mapmatch/rule_bases.h"
#include "msgs/map_doubt.h"

namespace maploop::mapmatch {

// Returns the arguments against a candidate, such as "azimuth differs by 47 degrees", "31 m away",
// "no legal turn leads there"; empty if there are none.
std::vector<std::string> objections(const MatchCandidate& candidate, const RoadNetwork& network);

// Returns the rules that applied to it with their weights, largest first.
std::vector<std::pair<std::string, double>> fired_rules(const MatchCandidate& candidate,
                                                        const RuleBases& rules);

// Returns a sentence on the result: the link and the reason for it, or why there is no link.
std::string explanation(const LinkMatch& match, const RoadNetwork& network);

// Returns a sentence on how a drive contradicts the map, such as "High Street (way 10) was driven
// against its one-way direction for 120 m".
std::string explanation(const MapDoubt& doubt, const RoadNetwork& network);

// Returns all of the above for a match of this network by these rules.
MapMatchWords in_words(const LinkMatch& match, const RoadNetwork& network, const RuleBases& rules);

}  // namespace maploop::mapmatch
