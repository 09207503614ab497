// Loads a road map, with a fault if one is asked for.
#pragma once

#include <memory>
#include <optional>

#include "runtime/vehicle/stages/road_map.h"
#include "tools/match/map_faults.h"

namespace maploop::tools {

// `driven` are the roads really driven, which some faults need. Throws as vehicle::load_road_map()
// and match::with_fault() do, and std::runtime_error for a fault without a map.
std::shared_ptr<const vehicle::RoadMap> load_road_map(const vehicle::MapParameters& parameters,
                                                      std::optional<match::MapFault> fault,
                                                      const match::Labels& driven);

}  // namespace maploop::tools
