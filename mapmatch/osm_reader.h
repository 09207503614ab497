// Reading the roads of an OpenStreetMap file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "mapmatch/network_builder.h"

namespace maploop::mapmatch {

// Degrees, WGS84.
struct GeographicBox {
  double west = -180.0, south = -90.0, east = 180.0, north = 90.0;
};

struct OsmOptions {
  // Only what lies inside: what the map has outside takes no memory.
  std::optional<GeographicBox> box;
  // Refuses more nodes (24 bytes each): a country of roads has some ten millions.
  std::size_t max_nodes = 50'000'000;
};

// The drivable roads of a .osm.pbf, .osm or .osm.gz/.bz2 file, as OpenStreetMap's wiki defines its
// tags: one-way streets (implied on motorways, their links and roundabouts), turn restrictions over
// a node, access for cars. Throws std::runtime_error naming the file and what to do: missing, no
// map, damaged, too large, or without a single road.
MapExtract read_osm(const std::filesystem::path& file, const OsmOptions& options = {});

}  // namespace maploop::mapmatch
