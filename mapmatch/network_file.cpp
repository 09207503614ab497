#include "mapmatch/network_file.h"

#include <stdexcept>
#include <string>
#include <string_view>

#include "mapmatch/network_builder.h"
#include "mapmatch/tiled_map.h"
#include "msgs/archive.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/whole_file.h"

namespace maploop::mapmatch {
namespace {

template <class Archive>
void describe(Archive& ar, auto& network) {
  ar.section("road network", 2);
  ar(network);
}

}  // namespace

bool is_network_file(const std::filesystem::path& file) {
  constexpr std::string_view signature = "maploop\n";
  return std::filesystem::is_regular_file(file) && read_head(file, signature.size()) == signature;
}

void save_network(const std::filesystem::path& file, const NetworkData& network) {
  write_whole_file(file, sealed_archive([&](auto& ar) { describe(ar, network); }));
}

NetworkData load_network(const std::filesystem::path& file) {
  try {
    NetworkData network;
    read_archive(file, input_limits::road_network, [&](auto& ar) { describe(ar, network); });
    return network;
  } catch (const FileError& e) {
    throw std::runtime_error("cannot load the road network " + std::string(e.what()));
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot load the road network " + file.string() + ": " + e.what());
  }
}

NetworkData open_network(const std::filesystem::path& file, const OsmOptions& options) {
  if (is_tiled_map(file)) {
    return build_network(
        TiledMap(file).read(options.box.value_or(GeographicBox{}), options.max_nodes));
  }
  if (!is_network_file(file)) return build_network(read_osm(file, options));
  if (options.box) {
    throw std::runtime_error("cannot read the part of " + file.string() +
                             " inside a box: a network file is read whole; give the map that it "
                             "was made from, or a tiled map");
  }
  return load_network(file);
}

}  // namespace maploop::mapmatch
