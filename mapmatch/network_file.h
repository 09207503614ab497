// A road network in a file of its own, which loads faster than the map it was made from.
//
// The file is an archive (msgs/archive.h): signature, version, length and checksum before the
// content, so that a damaged, cut or foreign file is refused.
#pragma once

#include <filesystem>

#include "mapmatch/osm_reader.h"
#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// Throws std::runtime_error naming the file where it cannot be written.
void save_network(const std::filesystem::path& file, const NetworkData& network);
// Throws std::runtime_error naming the file and what is wrong with it.
NetworkData load_network(const std::filesystem::path& file);

// A network of either kind of file: one of ours, or a map. Throws as load_network and read_osm do.
NetworkData open_network(const std::filesystem::path& file, const OsmOptions& options = {});

}  // namespace maploop::mapmatch
