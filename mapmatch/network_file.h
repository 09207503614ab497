// A network file stores a road network and loads faster than the map it was made from.
//
// The file is an archive (msgs/archive.h): signature, version, length and checksum precede the
// content, so that a damaged, truncated or foreign file is refused.
#pragma once

#include <filesystem>

#include "mapmatch/osm_reader.h"
#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// Returns whether the file begins as an archive.
bool is_network_file(const std::filesystem::path& file);

// Throws std::runtime_error, which names the file, if it cannot be written.
void save_network(const std::filesystem::path& file, const NetworkData& network);
// Throws std::runtime_error, which names the file and the error.
NetworkData load_network(const std::filesystem::path& file);

// Opens a network file, a tiled map or a map. With a box, of a tiled map the tiles that meet it.
// Throws as load_network, TiledMap and read_osm do.
NetworkData open_network(const std::filesystem::path& file, const OsmOptions& options = {});

}  // namespace maploop::mapmatch
