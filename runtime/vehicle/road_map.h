// The road map that a vehicle drives on.
#pragma once

#include <filesystem>
#include <memory>

#include "mapmatch/road_network.h"
#include "mapmatch/rule_bases.h"
#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

// Immutable: any number of vehicles and threads may use one at the same time.
struct RoadMap {
  mapmatch::RoadNetwork network;
  mapmatch::RuleBases rules;
};

// As [map] of the configuration says: an OpenStreetMap file or a network file, and rules of one's
// own. nullptr where there is no map to be used. Throws std::runtime_error naming the file.
std::shared_ptr<const RoadMap> load_road_map(const MapParameters& parameters);

}  // namespace maploop::vehicle
