#include "tests/mapmatch/small_map.h"

#include "msgs/frames.h"

namespace maploop::testing {

Geodetic SmallMap::place(double east, double north) {
  static const LocalFrame frame({radians(49.0), radians(8.4), 0.0});
  return frame.to_geodetic({east, north, 0.0});
}

SmallMap& SmallMap::node(std::int64_t id, double east, double north) {
  const Geodetic g = place(east, north);
  nodes_[id] = {id, degrees(g.latitude), degrees(g.longitude)};
  return *this;
}

SmallMap& SmallMap::way(std::int64_t id, std::vector<std::int64_t> nodes, mapmatch::Road road) {
  road.way_id = id;
  road.road_class = mapmatch::RoadClass::residential;
  map_.ways.push_back({road, std::move(nodes)});
  return *this;
}

SmallMap& SmallMap::ban(std::int64_t from_way, std::int64_t via_node, std::int64_t to_way,
                        bool only) {
  map_.restrictions.push_back({from_way, via_node, to_way, only});
  return *this;
}

mapmatch::MapExtract SmallMap::extract() const {
  mapmatch::MapExtract map = map_;
  for (const auto& [id, node] : nodes_) map.nodes.push_back(node);
  return map;
}

mapmatch::RoadNetwork SmallMap::network() const {
  return mapmatch::RoadNetwork(mapmatch::build_network(extract()));
}

mapmatch::Road one_way() {
  mapmatch::Road road;
  road.backward = false;
  return road;
}

}  // namespace maploop::testing
