// Lists the streets of a matched track in the order in which they were driven.
#pragma once

#include <string>
#include <vector>

#include "mapmatch/road.h"
#include "tools/match/match_output.h"

namespace maploop::match {

// Returns the name of a road, or that it has none, and its class.
std::string street_name(const mapmatch::Road& road);

// Consecutive fixes on roads of one name.
struct DrivenStreet {
  std::string name;
  double from = 0.0, to = 0.0;  // s since the track's first fix, of its first and last fix there
  double length = 0.0;          // m along the roads
  double probability = 0.0;     // mean P(link)
  std::size_t fixes = 0;
};

// Fixes that were not used do not end a street; a fix on no road does.
std::vector<DrivenStreet> driven_streets(const MatchedTrack& track,
                                         const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
