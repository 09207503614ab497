// Finds where the matcher doubted the map, or the map did not fit the drive.
#pragma once

#include <vector>

#include "tools/match/match_output.h"
#include "tools/web/plot.h"

namespace maploop::match {

// Returns in the order of time where the vehicle was on no road, where it was matched to a link
// that the map forbids (against a one-way direction, by a turn that is not legal, or without a
// connection), where P of the street was too low to be fed back although the position was better
// than the map, and where fixes were not used. Times are seconds since the track's first fix.
std::vector<web::Event> map_doubts(const MatchedTrack& track, const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
