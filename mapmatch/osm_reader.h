// The roads of an OpenStreetMap file are read here.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"

namespace maploop::mapmatch {

struct OsmOptions {
  // If set, reads only the nodes inside; map content outside takes no memory.
  std::optional<GeographicBox> box;
  // Refuses maps with more nodes (24 bytes each); the roads of a country have some ten million.
  std::size_t max_nodes = 50'000'000;
};

// Reads the drivable roads of a .osm.pbf, .osm or .osm.gz/.bz2 file by OpenStreetMap's tag
// definitions: one-way streets (implied on motorways, their links and roundabouts), turn
// restrictions over a node, access for cars. Throws std::runtime_error, which names the file and
// the remedy, if the file is missing, not a map, damaged, too large, or without roads.
MapExtract read_osm(const std::filesystem::path& file, const OsmOptions& options = {});

}  // namespace maploop::mapmatch
