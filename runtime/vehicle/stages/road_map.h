// Loads the road map that a vehicle drives on.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "mapmatch/geographic_box.h"
#include "mapmatch/road_network.h"
#include "mapmatch/rule_bases.h"
#include "mapmatch/tiled_map.h"
#include "runtime/vehicle/config/vehicle_config.h"

namespace maploop::vehicle {

// Tells where a map window (map_window.h) ends, and where it moves; m from its middle.
struct WindowSize {
  double reach = 4000.0;         // to each side, at least
  double begins_at = 2000.0;     // the next window's roads are read
  double goes_over_at = 2500.0;  // they replace those before
};

// A RoadMap is immutable: any number of vehicles and threads may use it at the same time.
struct RoadMap {
  mapmatch::RoadNetwork network;  // of a tiled map: without roads
  mapmatch::RuleBases rules;
  std::shared_ptr<const mapmatch::TiledMap> tiles{};  // nullptr if `network` holds the whole map
  RoadSide side_of_road = RoadSide::by_map;  // of `tiles`: the given one, or that of the whole map
  WindowSize window{};
};

// Loads what [map] of the configuration names: an OpenStreetMap file, a network file or a tiled
// map, and the user's rules if it names any. Returns nullptr if the mode is none or no file is
// named. Throws std::runtime_error naming the file that cannot be read.
std::shared_ptr<const RoadMap> load_road_map(const MapParameters& parameters);

// Returns the box, in degrees, that contains the whole map.
mapmatch::GeographicBox area_of(const RoadMap& map);

// Returns the network, of a tiled map that of the tiles within so many metres of the places. The
// map must outlive it. Throws std::runtime_error if a tile is damaged, or if the tiles have more
// than `max_nodes` nodes.
std::shared_ptr<const mapmatch::RoadNetwork> network_about(const RoadMap& map,
                                                           std::span<const Geodetic> places,
                                                           double metres,
                                                           std::size_t max_nodes = 50'000'000);

}  // namespace maploop::vehicle
