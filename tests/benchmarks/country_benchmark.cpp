// A road map of the size of a country: what its tiles need to be built, and to be opened.
//
//   country_benchmark [LINKS] [FOLDER]
//
// Draws a grid of LINKS roads (12 million: Germany's) over 640 x 870 km as FOLDER/country.osm.pbf,
// which it keeps for the next run, and needs 2 GB of disk there (default: a temporary folder).
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <osmium/builder/osm_object_builder.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/writer.hpp>
#include <string>

#include "mapmatch/map_area.h"
#include "mapmatch/road_network.h"
#include "mapmatch/tiled_map.h"
#include "mapmatch/tiled_map_builder.h"
#include "msgs/frames.h"
#include "msgs/time.h"

namespace {

namespace fs = std::filesystem;
using namespace maploop;

constexpr double south = 47.3, north = 55.1, west = 5.9, east = 15.0;  // degrees
constexpr std::int64_t bends = 4;         // nodes between two junctions
constexpr std::int64_t links_of_way = 3;  // as many junctions share a name
constexpr std::int64_t id_step = 200;     // most nodes of a map are of no road

double seconds_since(std::chrono::steady_clock::time_point start) {
  return to_seconds(std::chrono::steady_clock::now() - start);
}

// MB that this process has had in memory at most.
double peak() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kb = 0.0;
  while (status >> word)
    if (word == "VmHWM:") status >> kb;
  return kb / 1024.0;
}

// A grid of junctions; roads lead from each to the east and to the north.
class Grid {
 public:
  explicit Grid(double links)
      : columns_(static_cast<std::int64_t>(std::sqrt(0.5 * links * 640.0 / 870.0))),
        rows_(static_cast<std::int64_t>(0.5 * links / static_cast<double>(columns_))) {}

  void write(const fs::path& file) const {
    osmium::io::Writer writer(file.string(), osmium::io::overwrite::allow);
    osmium::memory::Buffer buffer(buffer_size);
    const auto flush = [&](std::size_t full) {
      if (buffer.committed() < full) return;
      writer(std::move(buffer));
      buffer = osmium::memory::Buffer(buffer_size);
    };
    for (std::int64_t row = 0; row < rows_; ++row) {
      for (std::int64_t column = 0; column < columns_; ++column) {
        for (std::int64_t bend = 0; bend <= 2 * bends; ++bend) {
          const bool up = bend > bends;
          const double part = static_cast<double>(up ? bend - bends : bend) / (bends + 1);
          const double x = static_cast<double>(column) + (up ? 0.05 * (part - part * part) : part);
          const double y = static_cast<double>(row) + (up ? part : 0.05 * (part - part * part));
          {
            osmium::builder::NodeBuilder node(buffer);
            node.set_id(id(row, column) + bend);
            node.set_location(
                osmium::Location{west + (east - west) * x / static_cast<double>(columns_),
                                 south + (north - south) * y / static_cast<double>(rows_)});
          }
          buffer.commit();
        }
        flush(buffer_size / 2);
      }
    }
    std::int64_t way = 1;
    for (std::int64_t row = 0; row < rows_; ++row) {
      for (std::int64_t column = 0; column < columns_; column += links_of_way, ++way)
        add_way(buffer, way, row, column, false);
      flush(buffer_size / 2);
    }
    for (std::int64_t column = 0; column < columns_; ++column) {
      for (std::int64_t row = 0; row < rows_; row += links_of_way, ++way)
        add_way(buffer, way, row, column, true);
      flush(buffer_size / 2);
    }
    flush(1);
    writer.close();
  }

 private:
  static constexpr std::size_t buffer_size = 16 << 20;

  std::int64_t id(std::int64_t row, std::int64_t column) const {
    return 1 + id_step * (row * columns_ + column);
  }

  void add_way(osmium::memory::Buffer& buffer, std::int64_t id_of_way, std::int64_t row,
               std::int64_t column, bool up) const {
    {
      osmium::builder::WayBuilder way(buffer);
      way.set_id(id_of_way);
      {
        osmium::builder::WayNodeListBuilder nodes(way);
        for (std::int64_t link = 0; link < links_of_way; ++link) {
          const std::int64_t r = row + (up ? link : 0), c = column + (up ? 0 : link);
          if (r + (up ? 1 : 0) >= rows_ || c + (up ? 0 : 1) >= columns_) break;
          if (link == 0) nodes.add_node_ref(id(r, c));
          for (std::int64_t bend = 1; bend <= bends; ++bend)
            nodes.add_node_ref(id(r, c) + bend + (up ? bends : 0));
          nodes.add_node_ref(up ? id(r + 1, c) : id(r, c + 1));
        }
      }
      osmium::builder::TagListBuilder tags(way);
      tags.add_tag("highway", id_of_way % 10 == 0 ? "primary" : "residential");
      tags.add_tag("name", "Road " + std::to_string(id_of_way));
    }
    buffer.commit();
  }

  std::int64_t columns_, rows_;
};

int run(double links, const fs::path& folder) {
  const fs::path map = folder / "country.osm.pbf", tiles = folder / "country.tiles";
  if (!fs::exists(map)) {
    std::cerr << "drawing the country\n";
    Grid(links).write(map);
  }
  const double before = peak();
  auto start = std::chrono::steady_clock::now();
  mapmatch::OsmOptions options;
  options.max_nodes = 100'000'000;
  const auto built = mapmatch::build_tiled_map(
      map, tiles, options, [](const std::string& step) { std::cerr << step << '\n'; });
  std::cout << fmt::format(
      "built {} ways with {} nodes in {} tiles in {:.0f} s; {:.0f} MB of memory at most ({:.0f} MB "
      "before); {:.0f} MB of map, {:.0f} MB of tiles\n",
      built.table.ways, built.table.nodes, built.table.tiles.size(), seconds_since(start), peak(),
      before, static_cast<double>(fs::file_size(map)) / 1e6,
      static_cast<double>(fs::file_size(tiles)) / 1e6);
  start = std::chrono::steady_clock::now();
  const mapmatch::TiledMap opened(tiles);
  std::cout << fmt::format("opened in {:.1f} ms\n", 1e3 * seconds_since(start));
  for (const double latitude : {47.9, 50.1, 53.3}) {
    start = std::chrono::steady_clock::now();
    const mapmatch::RoadNetwork network(mapmatch::build_network(
        opened.read(mapmatch::around({radians(latitude), radians(10.0), 0.0}, 4000.0))));
    std::cout << fmt::format("{:.1f} N: {} links about a place in {:.1f} ms\n", latitude,
                             network.size(), 1e3 * seconds_since(start));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const double links = argc > 1 ? std::stod(argv[1]) : 12e6;
    const fs::path folder =
        argc > 2 ? fs::path(argv[2]) : fs::temp_directory_path() / "maploop_country";
    fs::create_directories(folder);
    return run(links, folder);
  } catch (const std::exception& e) {
    std::cerr << "country_benchmark: " << e.what() << '\n';
    return 1;
  }
}
