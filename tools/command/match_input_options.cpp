#include "tools/command/match_input_options.h"

#include <optional>
#include <stdexcept>
#include <string>

#include "mapmatch/map_area.h"
#include "mapmatch/network_file.h"
#include "mapmatch/tiled_map.h"
#include "msgs/frames.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"

namespace maploop::tools {

mapmatch::RoadNetwork MatchInputOptions::network(
    const std::vector<std::filesystem::path>& tracks) const {
  constexpr double margin = 1000.0;  // m about each fix
  if (mapmatch::is_tiled_map(map)) {
    const mapmatch::TiledMap tiled(map);
    std::vector<Geodetic> places;
    std::optional<std::string> unreadable;
    for (const auto& file : box.empty() ? tracks : std::vector<std::filesystem::path>()) {
      try {
        for (const mapmatch::VehicleFix& fix : track(file)) places.push_back(fix.position);
      } catch (const std::runtime_error& e) {
        unreadable = e.what();  // who matches the track says it
      }
    }
    if (places.empty() && unreadable) throw std::runtime_error(*unreadable);
    const auto tiles = box.empty() ? tiled.tiles_about(places, margin)
                                   : tiled.tiles_within({box[0], box[1], box[2], box[3]});
    if (tiles.empty()) {
      throw std::runtime_error("the map covers " + to_text(tiled.area()) + ", and " +
                               (box.empty() ? "no track is near a road of it: is it the map of "
                                              "this place, and is latitude not longitude?"
                                            : "--box has no road of it"));
    }
    return mapmatch::RoadNetwork(mapmatch::build_network(tiled.read(tiles)),
                                 side_of_road.value_or(tiled.side_of_road()));
  }
  mapmatch::OsmOptions osm;
  if (!box.empty()) osm.box = {box[0], box[1], box[2], box[3]};
  return mapmatch::RoadNetwork(mapmatch::open_network(map, osm),
                               side_of_road.value_or(RoadSide::by_map));
}

match::Track MatchInputOptions::track(const std::filesystem::path& file) const {
  match::TrackOptions how;
  how.sigma = sigma;
  if (!origin.empty()) how.origin = Geodetic{radians(origin[0]), radians(origin[1]), 0.0};
  return match::read_track(file, how);
}

void add_map_argument(CLI::App& command, MatchInputOptions& options) {
  command
      .add_option("MAP", options.map,
                  "OpenStreetMap file, or network file or tiled map of `maploop map build`")
      ->required();
}

void add_match_input_options(CLI::App& command, MatchInputOptions& options) {
  command
      .add_option("--sigma", options.sigma,
                  "Metres an axis, of positions whose accuracy the track does not say")
      ->check(positive_number())
      ->capture_default_str();
  command.add_option("--origin", options.origin, "LAT,LON of a TUM track's local frame, degrees")
      ->delimiter(',')
      ->expected(2)
      ->check(finite_number());
  command
      .add_option("--box", options.box, "WEST,SOUTH,EAST,NORTH in degrees: only this part of MAP")
      ->delimiter(',')
      ->expected(4)
      ->check(finite_number());
  add_choice(&command, "--side-of-road", options.side_of_road,
             "Side on which traffic keeps (by-map: that of most opposite carriageways of MAP)");
  add_matcher_options(command, options);
}

}  // namespace maploop::tools
