// maploop map: road networks from OpenStreetMap.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/map_area.h"
#include "mapmatch/network_file.h"
#include "mapmatch/tiled_map.h"
#include "mapmatch/tiled_map_builder.h"
#include "msgs/frames.h"
#include "msgs/time.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/match/doubts_file.h"
#include "tools/match/map_corrections.h"

namespace maploop::tools {
namespace {

struct MapOptions {
  std::filesystem::path input, output, json, doubts;
  double min_probability = 0.9;  // of doubts that correct the map
  bool tiles = false;            // makes a tiled map
  std::vector<double> box;

  mapmatch::OsmOptions osm() const {
    mapmatch::OsmOptions options;
    if (box.empty()) return options;
    if (box[0] >= box[2] || box[1] >= box[3]) {
      throw std::runtime_error(
          "--box wants WEST,SOUTH,EAST,NORTH, west of east and south of north");
    }
    options.box = {box[0], box[1], box[2], box[3]};
    return options;
  }
};

struct OpenedNetwork {
  mapmatch::RoadNetwork network;
  double milliseconds;
};

void correct(mapmatch::MapExtract& map, const std::vector<MapDoubt>& doubts) {
  const match::Corrections done = match::correct(map, doubts);
  std::cout << fmt::format(
      "corrected: {} missing roads, {} directions, {} turns; {} doubts are left as they are\n",
      done.roads, done.directions, done.turns, done.left);
}

mapmatch::NetworkData corrected(const MapOptions& options) {
  const auto doubts = match::read_doubts(options.doubts, options.min_probability);
  mapmatch::MapExtract map = mapmatch::read_osm(options.input, options.osm());
  correct(map, doubts);
  return mapmatch::build_network(map);
}

OpenedNetwork open(const MapOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  mapmatch::RoadNetwork network(options.doubts.empty()
                                    ? mapmatch::open_network(options.input, options.osm())
                                    : corrected(options));
  const double seconds = to_seconds(std::chrono::steady_clock::now() - start);
  return {std::move(network), 1000.0 * seconds};
}

nlohmann::json describe(const mapmatch::RoadNetwork& network) {
  const mapmatch::NetworkData& data = network.data();
  double length = 0.0;
  std::size_t oneway = 0, bridges = 0, tunnels = 0, roundabouts = 0;
  std::map<std::string, std::size_t> classes;
  for (const mapmatch::Link& link : data.links) {
    length += link.length;
    if (link.one_way()) ++oneway;
  }
  const mapmatch::OneWayChecks& checks = network.one_way_checks();
  std::size_t doubted = 0;
  for (std::uint32_t link = 0; link < network.size(); ++link)
    doubted += network.doubted(link) ? 1 : 0;
  for (const mapmatch::Road& road : data.roads) {
    ++classes[std::string(to_string(road.road_class))];
    bridges += road.bridge ? 1 : 0;
    tunnels += road.tunnel ? 1 : 0;
    roundabouts += road.roundabout ? 1 : 0;
  }
  return {{"links", data.links.size()},
          {"one_way_links", oneway},
          {"opposite_carriageways_to_left", checks.to_left},
          {"opposite_carriageways_to_right", checks.to_right},
          {"doubted_directions", doubted},
          {"junctions", data.junctions.size()},
          {"vertices", data.vertices.size()},
          {"ways", data.roads.size()},
          {"ways_by_class", classes},
          {"bridges", bridges},
          {"tunnels", tunnels},
          {"roundabouts", roundabouts},
          {"banned_turns", data.banned.size()},
          {"length_km", length / 1000.0},
          {"origin", {degrees(data.origin.latitude), degrees(data.origin.longitude)}},
          {"warnings", data.warnings}};
}

void print(const nlohmann::json& info, double milliseconds) {
  std::cout << info["links"] << " links (" << info["one_way_links"] << " one way) of "
            << info["ways"] << " ways, " << info["length_km"].get<double>() << " km; "
            << info["junctions"] << " junctions, " << info["banned_turns"] << " banned turns, "
            << info["bridges"] << " bridges, " << info["tunnels"] << " tunnels, "
            << info["roundabouts"] << " roundabouts; its middle is at "
            << info["origin"][0].get<double>() << ", " << info["origin"][1].get<double>()
            << " (degrees north and east)\n";
  std::cout << "links with an opposite carriageway to the left: "
            << info["opposite_carriageways_to_left"]
            << ", to the right: " << info["opposite_carriageways_to_right"]
            << "; one-way links whose direction the map contradicts: " << info["doubted_directions"]
            << '\n';
  for (const auto& [name, count] : info["ways_by_class"].items())
    std::cout << "  " << name << ": " << count << '\n';
  for (const auto& warning : info["warnings"])
    std::cout << "note: " << warning.get<std::string>() << '\n';
  std::cout << "read in " << milliseconds << " ms\n";
}

int build_tiles(const MapOptions& options) {
  int step = 0;
  mapmatch::OsmOptions osm = options.osm();
  osm.max_nodes = 100'000'000;  // 16 bytes each
  mapmatch::MapCorrection correction;
  if (!options.doubts.empty()) {
    const auto doubts = match::read_doubts(options.doubts, options.min_probability);
    correction = {match::places_of(doubts),
                  [doubts](mapmatch::MapExtract& map) { correct(map, doubts); }};
  }
  const mapmatch::BuiltTiles built = mapmatch::build_tiled_map(
      options.input, options.output, osm,
      [&](const std::string& name) { std::cerr << fmt::format("[{}/4] {}\n", ++step, name); },
      correction);
  std::cout << fmt::format(
      "{} ways with {} nodes in {} tiles; {} turn restrictions\n"
      "wrote {}, {} bytes\n",
      built.table.ways, built.table.nodes, built.table.tiles.size(), built.table.restrictions,
      options.output.string(), std::filesystem::file_size(options.output));
  if (built.missing_nodes > 0 && options.box.empty()) {
    std::cout << fmt::format(
        "note: {} nodes of roads are missing in the map: their roads end there\n",
        built.missing_nodes);
  }
  return 0;
}

int build(const MapOptions& options) {
  if (options.tiles) return build_tiles(options);
  const OpenedNetwork opened = open(options);
  save_network(options.output, opened.network.data());
  print(describe(opened.network), opened.milliseconds);
  std::cout << "wrote " << options.output.string() << ", "
            << std::filesystem::file_size(options.output) << " bytes\n";
  return 0;
}

int tiled_info(const MapOptions& options) {
  const mapmatch::TiledMap map(options.input);
  const mapmatch::TileTable& table = map.table();
  std::cout << fmt::format(
      "tiled map: {} ways with {} nodes in {} tiles, {} turn restrictions; {}\n"
      "traffic keeps to the {}: {} links have an opposite carriageway to the left, {} to the "
      "right (a link counts in each tile that it is in)\n",
      table.ways, table.nodes, table.tiles.size(), table.restrictions,
      mapmatch::to_text(map.area()), to_string(map.side_of_road()), table.to_left, table.to_right);
  if (table.restrictions_over_ways > 0) {
    std::cout << fmt::format("note: {} turn restrictions via a way are left out\n",
                             table.restrictions_over_ways);
  }
  if (options.json.empty()) return 0;
  write_json_file(options.json, {{"tiles", table.tiles.size()},
                                 {"ways", table.ways},
                                 {"vertices", table.nodes},
                                 {"turn_restrictions", table.restrictions},
                                 {"opposite_carriageways_to_left", table.to_left},
                                 {"opposite_carriageways_to_right", table.to_right}});
  return 0;
}

int info(const MapOptions& options) {
  if (options.box.empty() && mapmatch::is_tiled_map(options.input)) return tiled_info(options);
  const OpenedNetwork opened = open(options);
  if (opened.network.size() == 0) {
    throw std::runtime_error(options.input.string() +
                             (options.box.empty() ? " has no roads" : " has no roads in the box"));
  }
  nlohmann::json described = describe(opened.network);
  print(described, opened.milliseconds);
  described["read_ms"] = opened.milliseconds;
  if (!options.json.empty()) write_json_file(options.json, described);
  return 0;
}

}  // namespace

void add_map(CLI::App& app, Command& command) {
  CLI::App* map = app.add_subcommand("map", "Road networks from OpenStreetMap");
  map->require_subcommand(1);
  auto options = std::make_shared<MapOptions>();
  const auto add_input = [&](CLI::App* sub, const char* what) {
    sub->add_option("MAP", options->input, what)->required();
    sub->add_option("--box", options->box,
                    "WEST,SOUTH,EAST,NORTH in degrees: only what lies inside")
        ->delimiter(',')
        ->expected(4)
        ->check(finite_number());
  };
  CLI::App* sub = map->add_subcommand("build", "Make a network file, which loads fast, from a map");
  add_input(sub, "OpenStreetMap file: .osm.pbf, .osm, .osm.gz or .osm.bz2");
  sub->add_option("NETWORK", options->output, "File to write")->required()->check(writable_file());
  CLI::Option* doubts =
      sub->add_option(
             "--doubts", options->doubts,
             "Correct the map by this file of `maploop map doubts`: missing roads are "
             "added, whole ways opened in both directions, and turns allowed; shifted roads "
             "are left")
          ->check(existing_file());
  sub->add_flag("--tiles", options->tiles,
                "Make a tiled map instead, for countries: it is read only near the vehicle");
  sub->add_option("--doubts-probability", options->min_probability,
                  "Only by those that are at least so likely")
      ->needs(doubts)
      ->check(number_in(0.0, 1.0))
      ->capture_default_str();
  sub->callback([options, &command] { command = [options] { return build(*options); }; });

  add_map_doubts(*map, command);

  sub = map->add_subcommand("info", "What a map has");
  add_input(sub, "OpenStreetMap file, or network file or tiled map of `maploop map build`");
  sub->add_option("--json", options->json, "Write it to this file as JSON, too")
      ->check(writable_file());
  sub->callback([options, &command] { command = [options] { return info(*options); }; });
}

}  // namespace maploop::tools
