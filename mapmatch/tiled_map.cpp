#include "mapmatch/tiled_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "msgs/archive.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::mapmatch {
namespace {

constexpr std::int32_t rows = 3600, columns = 7200;  // of the Earth
constexpr double coordinate = 1e7;                   // of a degree
// What has these many bytes is sealed, with a section.
const std::size_t head_size = [] {
  ArchiveWriter writer;
  writer(TiledMapHead{});
  return seal(writer.content()).size();
}();

// Reads a sealed value from a part of a file.
template <class T>
T read_part(const std::filesystem::path& file, std::uint64_t offset, std::uint64_t size) {
  if (size > input_limits::road_network) throw ArchiveError("its size is damaged");
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto length = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
  if (!in || offset > length || size > length - offset) throw ArchiveError("the file is cut");
  Bytes sealed(size);
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(reinterpret_cast<char*>(sealed.data()), static_cast<std::streamsize>(size));
  if (!in) throw ArchiveError("it cannot be read");
  ArchiveReader reader(unseal(sealed));
  T value;
  reader(value);
  reader.finish();
  return value;
}

GeographicBox box_of(const TilePlace& place) {
  return {place.column * tile_size - 180.0, place.row * tile_size - 90.0,
          (place.column + 1) * tile_size - 180.0, (place.row + 1) * tile_size - 90.0};
}

std::string to_text(const TilePlace& place) {
  const GeographicBox box = box_of(place);
  return "the tile at " + std::to_string(box.south) + ", " + std::to_string(box.west);
}

// Sorts by a key and keeps the first of those that are equal.
template <class T, class Key>
void sort_once(std::vector<T>& values, Key key) {
  std::stable_sort(values.begin(), values.end(),
                   [&](const T& a, const T& b) { return key(a) < key(b); });
  values.erase(std::unique(values.begin(), values.end(),
                           [&](const T& a, const T& b) { return key(a) == key(b); }),
               values.end());
}

void append(MapExtract& map, const Tile& tile) {
  for (const TiledWay& tiled : tile.ways) {
    MapWay way{tiled.road, {}};
    way.nodes.reserve(tiled.nodes.size());
    for (const TiledNode& n : tiled.nodes) {
      way.nodes.push_back(n.id);
      if (n.latitude != TiledNode::nowhere)
        map.nodes.push_back({n.id, n.latitude / coordinate, n.longitude / coordinate});
    }
    map.ways.push_back(std::move(way));
  }
  map.restrictions.insert(map.restrictions.end(), tile.restrictions.begin(),
                          tile.restrictions.end());
}

}  // namespace

TilePlace tile_at(double latitude, double longitude) {
  const auto number = [](double from_corner, std::int32_t count) {
    return std::clamp(static_cast<std::int32_t>(std::floor(from_corner / tile_size)), 0, count - 1);
  };
  return {number(latitude + 90.0, rows), number(longitude + 180.0, columns)};
}

bool is_tiled_map(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) return false;
  const std::string head = read_head(file, head_size);
  return head.find(TiledMapHead::section) != std::string::npos && head.starts_with("maploop\n");
}

TiledMap::TiledMap(std::filesystem::path file) : file_(std::move(file)) {
  try {
    const auto head = read_part<TiledMapHead>(file_, 0, head_size);
    table_ = read_part<TileTable>(file_, head.table_offset, head.table_size);
    const auto by_place = [](const TileEntry& a, const TileEntry& b) { return a.place < b.place; };
    if (!std::is_sorted(table_.tiles.begin(), table_.tiles.end(), by_place))
      throw ArchiveError("its tiles are not in order");
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot read the tiled map " + file_.string() + ": " + e.what());
  }
}

MapExtract TiledMap::read(const GeographicBox& box, std::size_t max_nodes) const {
  MapExtract map;
  map.restrictions_over_ways = table_.restrictions_over_ways;
  const TilePlace low = tile_at(box.south, box.west), high = tile_at(box.north, box.east);
  const auto meets = [&](std::int32_t column) {
    return low.column <= high.column ? column >= low.column && column <= high.column
                                     : column >= low.column || column <= high.column;
  };
  const auto first = std::lower_bound(
      table_.tiles.begin(), table_.tiles.end(), low.row,
      [](const TileEntry& entry, std::int32_t row) { return entry.place.row < row; });
  for (auto entry = first; entry != table_.tiles.end() && entry->place.row <= high.row; ++entry) {
    if (!meets(entry->place.column)) continue;
    try {
      append(map, read_part<Tile>(file_, entry->offset, entry->size));
    } catch (const std::exception& e) {
      throw std::runtime_error("cannot read the tiled map " + file_.string() + ": " +
                               to_text(entry->place) + ": " + e.what() + "; build the map again");
    }
    if (map.nodes.size() > max_nodes) {
      throw std::runtime_error("cannot read the tiled map " + file_.string() +
                               ": the part has more than " + std::to_string(max_nodes) +
                               " nodes; select a smaller part with a box");
    }
  }
  sort_once(map.nodes, [](const MapNode& n) { return n.id; });
  sort_once(map.ways, [](const MapWay& w) { return w.road.way_id; });
  sort_once(map.restrictions, [](const MapRestriction& r) {
    return std::tuple(r.via_node, r.from_way, r.to_way, r.only);
  });
  return map;
}

GeographicBox TiledMap::area() const {
  GeographicBox area = no_area;
  for (const TileEntry& entry : table_.tiles) area = joined(area, box_of(entry.place));
  return area;
}

}  // namespace maploop::mapmatch
