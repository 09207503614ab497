// Tiled maps are made here from OpenStreetMap files of any size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "mapmatch/osm_reader.h"
#include "mapmatch/tiled_map_format.h"

namespace maploop::mapmatch {

struct BuiltTiles {
  TileTable table;
  // Nodes of roads that the map, or the box, lacks: their roads end there.
  std::size_t missing_nodes = 0;
};

// Corrects a map near some places. What touches their tiles is in memory at once.
struct MapCorrection {
  std::set<TilePlace> places;
  std::function<void(MapExtract&)> correct = {};  // is given all roads that touch these tiles
};

// Writes the drivable roads of a .osm.pbf, .osm or .osm.gz/.bz2 file as a tiled map, as read_osm
// reads them. It needs about 16 bytes of memory for each node of a road, and 300 MB more; beside
// the result there is, until it is complete, a file of about its size. `progress` is told the name
// of each step when it begins, of which there are 4. Throws std::runtime_error, which names the
// file and the remedy, as read_osm does, or if the result cannot be written.
BuiltTiles build_tiled_map(
    const std::filesystem::path& map, const std::filesystem::path& result,
    const OsmOptions& options = {},
    const std::function<void(const std::string& step)>& progress = [](const std::string&) {},
    const MapCorrection& correction = {});

}  // namespace maploop::mapmatch
