// Why fixes of a track found no road of the map.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/match/match_output.h"

namespace maploop::match {

// The fixes that the matcher refused and those outside of the map, counted by their reason.
std::map<std::string, std::size_t> unused_fixes(const MatchedTrack& track,
                                                const mapmatch::RoadNetwork& network);

// The reason and the remedy where the track is of no use with this map: no fix is on a road, or
// the matcher refused more than half of them. Nothing for every other track.
std::optional<std::string> why_unusable(const MatchedTrack& track,
                                        const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
