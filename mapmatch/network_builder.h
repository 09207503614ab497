// The links of a road network are built here from the ways of a map.
#pragma once

#include <algorithm>
#include <cstddef>
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

// Forbids the turn from one way to another at a node, or, if `only` is set, all other turns.
struct MapRestriction {
  std::int64_t from_way = 0, via_node = 0, to_way = 0;
  bool only = false;

  void archive(auto& ar) { ar(from_way, via_node, to_way, only); }
};

struct MapExtract {
  std::vector<MapNode> nodes;  // sorted by id, each once
  std::vector<MapWay> ways;
  std::vector<MapRestriction> restrictions;
  std::size_t restrictions_over_ways = 0;  // number left out because their "via" is a way

  // Returns the node with this id, or nullptr if the map lacks it.
  const MapNode* find(std::int64_t id) const {
    const auto found = std::ranges::lower_bound(nodes, id, {}, &MapNode::id);
    return found != nodes.end() && found->id == id ? &*found : nullptr;
  }
};

// Builds a network. A way is cut at a missing node (clipped map); the data's warnings count what is
// left out. Positions lie in one plane about the map's middle, also across the 180th meridian; a
// warning is added for a map that reaches more than 500 km from its middle. A map without roads
// gives an empty network.
NetworkData build_network(const MapExtract& map);

}  // namespace maploop::mapmatch
