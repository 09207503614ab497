// The roads near what is wrong with a map are corrected here, while the map becomes tiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "mapmatch/tile_collector.h"
#include "mapmatch/tiled_map_builder.h"

namespace maploop::mapmatch {

// Keeps the roads that touch the places of a correction until all are there.
class CorrectedRoads {
 public:
  explicit CorrectedRoads(const MapCorrection& correction) : correction_(correction) {}

  // Returns whether the way is kept.
  bool keep(const TiledWay& way) {
    if (correction_.places.empty()) return false;
    const std::set<TilePlace> touched = TileCollector::places_of(way);
    if (std::none_of(touched.begin(), touched.end(),
                     [&](const TilePlace& p) { return correction_.places.contains(p); }))
      return false;
    kept_.ways.push_back(way);
    return true;
  }

  bool keep(const MapRestriction& restriction, const TiledNode& via) {
    if (!correction_.places.contains(TileCollector::place_of(via))) return false;
    kept_.restrictions.push_back(restriction);
    return true;
  }

  // Adds what was kept, corrected.
  void give(TileCollector& tiles, TileTable& table) {
    if (!correction_.correct) return;
    MapExtract map;
    append(map, std::exchange(kept_, {}));
    sort_once(map);
    const std::size_t nodes = map.nodes.size();
    correction_.correct(map);
    for (const MapWay& way : map.ways) {
      TiledWay tiled{way.road, {}};
      for (const std::int64_t id : way.nodes) tiled.nodes.push_back(node(map, id));
      tiles.add(tiled);
    }
    for (const MapRestriction& r : map.restrictions) tiles.add(r, node(map, r.via_node));
    table.ways += map.ways.size();
    table.nodes += map.nodes.size() - nodes;
    table.restrictions += map.restrictions.size();
  }

 private:
  static TiledNode node(const MapExtract& map, std::int64_t id) {
    const MapNode* found = map.find(id);
    if (found == nullptr) return {id};
    const auto units = [](double degrees) {
      return static_cast<std::int32_t>(std::lround(degrees * TiledNode::per_degree));
    };
    return {id, units(found->latitude), units(found->longitude)};
  }

  const MapCorrection& correction_;
  Tile kept_;
};

}  // namespace maploop::mapmatch
