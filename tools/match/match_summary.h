// Counts what became of the fixes of a track.
#pragma once

#include <map>
#include <string>

#include "tools/match/match_output.h"

namespace maploop::match {

constexpr double sure = 0.9;  // P(link), below which a match is doubtful

// Each fix is counted as matched, as off road, or as not used.
struct MatchSummary {
  std::size_t fixes = 0;
  std::size_t matched = 0;
  std::size_t off_road = 0;                   // inside the map, but on none of its roads
  std::map<std::string, std::size_t> unused;  // refused or outside of the map, by the reason
  std::size_t doubtful = 0;                   // matched with a P(link) below `sure`

  // Returns the share of the matched fixes that are doubtful; 0 if none is matched.
  double doubtful_share() const;
};

MatchSummary summary(const MatchedTrack& track, const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
