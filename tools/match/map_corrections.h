// A map is corrected by what drives contradict in it.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "mapmatch/tiled_map_format.h"
#include "msgs/map_doubt.h"

namespace maploop::match {

// Says what became of doubts.
struct Corrections {
  std::size_t roads = 0, directions = 0, turns = 0;  // corrected
  std::size_t left = 0;  // shifted roads, and what the map has no longer
};

// Returns the tiles of a tiled map that a correction by these doubts needs.
std::set<mapmatch::TilePlace> places_of(const std::vector<MapDoubt>& doubts);

// A missing road becomes a way that is open in both directions (`highway=road`) and joins the ways
// driven before and after it; a way that was driven against its direction is opened in both; a turn
// that was driven is no longer forbidden. Ways and nodes that are added have ids from 2^50 on,
// which OpenStreetMap does not use.
Corrections correct(mapmatch::MapExtract& map, const std::vector<MapDoubt>& doubts);

}  // namespace maploop::match
