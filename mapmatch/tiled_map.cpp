#include "mapmatch/tiled_map.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "mapmatch/map_area.h"
#include "msgs/archive.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::mapmatch {
namespace {

constexpr std::int32_t rows = 3600, columns = 7200;  // of the Earth
constexpr std::uint64_t most_bytes = 1ULL << 50U;    // of a file
const std::size_t head_size = sealed(TiledMapHead{}).size();

ArchiveError unreadable() {
  return ArchiveError(std::string("it cannot be read: ") + std::strerror(errno));
}

// Reads a sealed value from a part of a file.
template <class T>
T read_part(int file, std::uint64_t offset, std::uint64_t size) {
  if (size > input_limits::map_tile) throw ArchiveError("its size is damaged");
  Bytes sealed(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        pread(file, sealed.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw unreadable();
    if (got == 0) throw ArchiveError("the file is cut");
    done += static_cast<std::size_t>(got);
  }
  ArchiveReader reader(unseal(sealed));
  T value;
  reader(value);
  reader.finish();
  return value;
}

void check(const TileTable& table) {
  const TileEntry* last = nullptr;
  for (const TileEntry& entry : table.tiles) {
    const TilePlace& place = entry.place;
    if (place.row < 0 || place.row >= rows || place.column < 0 || place.column >= columns)
      throw ArchiveError("a tile is not on the Earth");
    if (entry.size > input_limits::map_tile || entry.offset > most_bytes)
      throw ArchiveError("the size of a tile is damaged");
    if (last != nullptr && (!(last->place < place) || entry.offset < last->offset + last->size))
      throw ArchiveError("its tiles are not in order");
    last = &entry;
  }
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
void keep_once(std::vector<T>& values, Key key) {
  std::stable_sort(values.begin(), values.end(),
                   [&](const T& a, const T& b) { return key(a) < key(b); });
  values.erase(std::unique(values.begin(), values.end(),
                           [&](const T& a, const T& b) { return key(a) == key(b); }),
               values.end());
}

}  // namespace

void append(MapExtract& map, const Tile& tile) {
  for (const TiledWay& tiled : tile.ways) {
    MapWay way{tiled.road, {}};
    way.nodes.reserve(tiled.nodes.size());
    for (const TiledNode& n : tiled.nodes) {
      way.nodes.push_back(n.id);
      if (n.latitude != TiledNode::nowhere) {
        map.nodes.push_back(
            {n.id, n.latitude / TiledNode::per_degree, n.longitude / TiledNode::per_degree});
      }
    }
    map.ways.push_back(std::move(way));
  }
  map.restrictions.insert(map.restrictions.end(), tile.restrictions.begin(),
                          tile.restrictions.end());
}

void sort_once(MapExtract& map) {
  keep_once(map.nodes, [](const MapNode& n) { return n.id; });
  keep_once(map.ways, [](const MapWay& w) { return w.road.way_id; });
  keep_once(map.restrictions, [](const MapRestriction& r) {
    return std::tuple(r.via_node, r.from_way, r.to_way, r.only);
  });
}

TilePlace tile_at(double latitude, double longitude) {
  const auto number = [](double from_corner, std::int32_t count) {
    const double tile = std::floor(from_corner / tile_size);
    return tile > 0.0 ? static_cast<std::int32_t>(std::min(tile, count - 1.0)) : 0;
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
    const int opened = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) throw unreadable();
    descriptor_ = std::shared_ptr<const int>(new int(opened), [](const int* descriptor) {
      close(*descriptor);
      delete descriptor;
    });
    const auto head = read_part<TiledMapHead>(*descriptor_, 0, head_size);
    if (head.table_offset > most_bytes) throw ArchiveError("the place of its table is damaged");
    table_ = read_part<TileTable>(*descriptor_, head.table_offset, head.table_size);
    if (std::filesystem::file_size(file_) != head.table_offset + head.table_size)
      throw ArchiveError("its size is not the stated one: it is cut, or joined to another file");
    check(table_);
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot read the tiled map " + file_.string() + ": " + e.what());
  }
}

std::vector<TileEntry>::const_iterator TiledMap::at_or_after(const TilePlace& place) const {
  return std::lower_bound(table_.tiles.begin(), table_.tiles.end(), place,
                          [](const TileEntry& e, const TilePlace& p) { return e.place < p; });
}

std::set<TilePlace> TiledMap::tiles_within(const GeographicBox& box) const {
  const TilePlace low = tile_at(box.south, box.west), high = tile_at(box.north, box.east);
  std::set<TilePlace> tiles;
  const auto add = [&](std::int32_t row, std::int32_t first, std::int32_t last) {
    for (auto entry = at_or_after({row, first});
         entry != table_.tiles.end() && entry->place <= TilePlace{row, last}; ++entry)
      tiles.insert(entry->place);
  };
  for (std::int32_t row = low.row; row <= high.row; ++row) {
    if (low.column <= high.column) {
      add(row, low.column, high.column);
    } else {
      add(row, low.column, columns - 1);
      add(row, 0, high.column);
    }
  }
  return tiles;
}

std::set<TilePlace> TiledMap::tiles_about(std::span<const Geodetic> places, double metres) const {
  std::set<TilePlace> tiles;
  for (const Geodetic& place : places) tiles.merge(tiles_within(around(place, metres)));
  return tiles;
}

MapExtract TiledMap::read(const GeographicBox& box, std::size_t max_nodes) const {
  return read(tiles_within(box), max_nodes);
}

MapExtract TiledMap::read(const std::set<TilePlace>& tiles, std::size_t max_nodes) const {
  MapExtract map;
  std::size_t nodes = 0;  // of all ways; one of several tiles counts in each
  for (const TilePlace& place : tiles) {
    const auto entry = at_or_after(place);
    if (entry == table_.tiles.end() || entry->place != place) continue;
    try {
      const auto tile = read_part<Tile>(*descriptor_, entry->offset, entry->size);
      if (tile.place != place) throw ArchiveError("another tile is in its place");
      for (const TiledWay& way : tile.ways) nodes += way.nodes.size();
      nodes += tile.ways.size() + tile.restrictions.size();
      if (nodes <= max_nodes) append(map, tile);
    } catch (const std::exception& e) {
      throw std::runtime_error("cannot read the tiled map " + file_.string() + ": " +
                               to_text(place) + ": " + e.what() + "; build the map again");
    }
    if (nodes > max_nodes) {
      throw std::runtime_error("cannot read the tiled map " + file_.string() +
                               ": the part has more than " + std::to_string(max_nodes) +
                               " nodes; select a smaller part with a box");
    }
  }
  sort_once(map);
  return map;
}

RoadSide TiledMap::side_of_road() const {
  return table_.to_right > table_.to_left ? RoadSide::left : RoadSide::right;
}

GeographicBox TiledMap::area() const {
  GeographicBox area = no_area;
  for (const TileEntry& entry : table_.tiles) area = joined(area, box_of(entry.place));
  return area;
}

}  // namespace maploop::mapmatch
