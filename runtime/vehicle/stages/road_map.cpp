#include "runtime/vehicle/stages/road_map.h"

#include "mapmatch/network_file.h"

namespace maploop::vehicle {

std::shared_ptr<const RoadMap> load_road_map(const MapParameters& parameters) {
  if (parameters.mode == MapMode::none || parameters.file.empty()) return nullptr;
  return std::make_shared<const RoadMap>(RoadMap{
      mapmatch::RoadNetwork(mapmatch::open_network(parameters.file), parameters.side_of_road),
      mapmatch::read_rule_bases(parameters.rules.empty()
                                    ? mapmatch::default_rules()
                                    : std::filesystem::path(parameters.rules))});
}

}  // namespace maploop::vehicle
