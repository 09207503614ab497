// Explains why fixes of a track are not on a road of the map.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/match/match_output.h"

namespace maploop::match {

// Counts the fixes that the matcher refused and those outside of the map, by their reason.
std::map<std::string, std::size_t> unused_fixes(const MatchedTrack& track,
                                                const mapmatch::RoadNetwork& network);

// Returns the reason and the remedy if the track cannot be used with this map: no fix is on a road,
// or the matcher refused more than half of them. Returns nothing otherwise.
std::optional<std::string> why_unusable(const MatchedTrack& track,
                                        const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
