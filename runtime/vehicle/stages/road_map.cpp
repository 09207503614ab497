#include "runtime/vehicle/stages/road_map.h"

#include <utility>

#include "mapmatch/map_area.h"
#include "mapmatch/network_file.h"

namespace maploop::vehicle {

std::shared_ptr<const RoadMap> load_road_map(const MapParameters& parameters) {
  if (parameters.mode == MapMode::none || parameters.file.empty()) return nullptr;
  auto rules =
      mapmatch::read_rule_bases(parameters.rules.empty() ? mapmatch::default_rules()
                                                         : std::filesystem::path(parameters.rules));
  std::shared_ptr<const mapmatch::TiledMap> tiles;
  mapmatch::NetworkData roads;
  if (mapmatch::is_tiled_map(parameters.file)) {
    tiles = std::make_shared<const mapmatch::TiledMap>(parameters.file);
  } else {
    roads = mapmatch::open_network(parameters.file);
  }
  const RoadSide side = tiles && parameters.side_of_road == RoadSide::by_map
                            ? tiles->side_of_road()
                            : parameters.side_of_road;
  return std::make_shared<const RoadMap>(RoadMap{mapmatch::RoadNetwork(std::move(roads), side),
                                                 std::move(rules), std::move(tiles), side});
}

mapmatch::GeographicBox area_of(const RoadMap& map) {
  return map.tiles ? map.tiles->area() : mapmatch::area_of(map.network);
}

std::shared_ptr<const mapmatch::RoadNetwork> network_about(const RoadMap& map,
                                                           std::span<const Geodetic> places,
                                                           double metres, std::size_t max_nodes) {
  if (!map.tiles) return {std::shared_ptr<void>(), &map.network};
  return std::make_shared<const mapmatch::RoadNetwork>(
      mapmatch::build_network(map.tiles->read(map.tiles->tiles_about(places, metres), max_nodes)),
      map.side_of_road);
}

}  // namespace maploop::vehicle
