// Makes links from the ways of a map.
#pragma once

#include <cstdint>
#include <vector>

#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

struct MapNode {
  std::int64_t id = 0;
  double latitude = 0.0, longitude = 0.0;  // degrees
};

struct MapWay {
  Road road;
  std::vector<std::int64_t> nodes;
};

// "No turn" (or, `only`: no other turn) from way to way at a node.
struct MapRestriction {
  std::int64_t from_way = 0, via_node = 0, to_way = 0;
  bool only = false;
};

struct MapExtract {
  std::vector<MapNode> nodes;  // sorted by id, each once
  std::vector<MapWay> ways;
  std::vector<MapRestriction> restrictions;
  std::size_t restrictions_over_ways = 0;  // left out: their "via" is a way
};

// A way is cut where a node is missing (a clipped map); what is left out is counted in the data's
// warnings. Places are in one plane about the map's middle, across the 180th meridian too: a map of
// more than some 1000 km is warned of. A map without any road gives an empty network.
NetworkData build_network(const MapExtract& map);

}  // namespace maploop::mapmatch
