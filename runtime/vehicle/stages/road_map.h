// Loads the road map that a vehicle drives on.
#pragma once

#include <filesystem>
#include <memory>

#include "mapmatch/road_network.h"
#include "mapmatch/rule_bases.h"
#include "runtime/vehicle/config/vehicle_config.h"

namespace maploop::vehicle {

// A RoadMap is immutable: any number of vehicles and threads may use it at the same time.
struct RoadMap {
  mapmatch::RoadNetwork network;
  mapmatch::RuleBases rules;
};

// Loads what [map] of the configuration names: an OpenStreetMap file or a network file, and the
// user's rules if it names any. Returns nullptr if the mode is none or no file is named. Throws
// std::runtime_error naming the file that cannot be read.
std::shared_ptr<const RoadMap> load_road_map(const MapParameters& parameters);

}  // namespace maploop::vehicle
