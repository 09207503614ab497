#include "tools/replay/wrong_road_map.h"

#include <stdexcept>
#include <utility>

#include "mapmatch/osm_reader.h"

namespace maploop::tools {

std::shared_ptr<const vehicle::RoadMap> load_road_map(const vehicle::MapParameters& parameters,
                                                      std::optional<match::MapFault> fault,
                                                      const match::Labels& driven) {
  auto map = vehicle::load_road_map(parameters);
  if (!fault) return map;
  if (map == nullptr) throw std::runtime_error("--map-fault needs a map: --map FILE");
  auto wrong = match::with_fault(mapmatch::read_osm(parameters.file), driven, *fault);
  return std::make_shared<const vehicle::RoadMap>(vehicle::RoadMap{
      mapmatch::RoadNetwork(std::move(wrong), parameters.side_of_road), map->rules});
}

}  // namespace maploop::tools
