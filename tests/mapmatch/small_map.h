// Hand-made maps are drawn here in metres.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapmatch/network_builder.h"

namespace maploop::testing {

// Nodes are given in metres east and north of 49 N 8.4 E, ways by their nodes' ids.
class SmallMap {
 public:
  SmallMap& node(std::int64_t id, double east, double north);
  // The road is residential and open in both directions unless `road` states otherwise.
  SmallMap& way(std::int64_t id, std::vector<std::int64_t> nodes, mapmatch::Road road = {});
  SmallMap& ban(std::int64_t from_way, std::int64_t via_node, std::int64_t to_way,
                bool only = false);

  mapmatch::MapExtract extract() const;
  mapmatch::RoadNetwork network() const;
  // Returns the geodetic place at metres east and north of 49 N 8.4 E. (The network's own frame has
  // its origin in the middle of the map.)
  static Geodetic place(double east, double north);

 private:
  std::map<std::int64_t, mapmatch::MapNode> nodes_;
  mapmatch::MapExtract map_;
};

// Returns a road that may be driven forward only.
mapmatch::Road one_way();

}  // namespace maploop::testing
