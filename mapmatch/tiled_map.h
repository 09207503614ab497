// A tiled map holds the roads of a country in one file, of which only the tiles near the vehicle
// are read.
//
// A tile is 0.05 degrees wide and high, and holds every way that touches it, whole. Ways of several
// tiles are in each of them. The file consists of archives (msgs/archive.h), each with its own
// checksum: a head, the tiles, and the table that tells where each tile is. So a damaged tile is
// refused, and the others remain readable.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>
#include <vector>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"

namespace maploop::mapmatch {

constexpr double tile_size = 0.05;  // degrees

// Tells which tile it is.
struct TilePlace {
  std::int32_t row = 0;     // from 90 degrees south to the north
  std::int32_t column = 0;  // from 180 degrees west to the east

  auto operator<=>(const TilePlace&) const = default;
};

// Returns the tile that contains a place (degrees).
TilePlace tile_at(double latitude, double longitude);

// This is a node of a way in a tile.
struct TiledNode {
  static constexpr std::int32_t nowhere = std::numeric_limits<std::int32_t>::max();

  std::int64_t id = 0;              // OpenStreetMap's
  std::int32_t latitude = nowhere;  // 1e-7 degrees; `nowhere`: the map lacks this node
  std::int32_t longitude = 0;       // 1e-7 degrees

  void archive(auto& ar) { ar(id, latitude, longitude); }
};

struct TiledWay {
  Road road;
  std::vector<TiledNode> nodes;

  void archive(auto& ar) { ar(road, nodes); }
};

struct Tile {
  static constexpr std::string_view section = "map tile";
  static constexpr std::uint32_t version = 1;

  std::vector<TiledWay> ways;
  std::vector<MapRestriction> restrictions;  // over a node in this tile

  void archive(auto& ar) {
    ar.section(section, version);
    ar(ways, restrictions);
  }
};

// Tells where in the file a tile is.
struct TileEntry {
  TilePlace place;
  std::uint64_t offset = 0, size = 0;  // bytes

  void archive(auto& ar) { ar(place.row, place.column, offset, size); }
};

struct TileTable {
  static constexpr std::string_view section = "table of tiles";
  static constexpr std::uint32_t version = 1;

  std::vector<TileEntry> tiles;  // by place
  std::uint64_t restrictions_over_ways = 0;

  void archive(auto& ar) {
    ar.section(section, version);
    ar(tiles, restrictions_over_ways);
  }
};

// This is the first content of the file; it always has the same size.
struct TiledMapHead {
  static constexpr std::string_view section = "tiled map";
  static constexpr std::uint32_t version = 1;

  std::uint64_t table_offset = 0, table_size = 0;  // bytes

  void archive(auto& ar) {
    ar.section(section, version);
    ar(table_offset, table_size);
  }
};

// Returns whether the file begins as a tiled map.
bool is_tiled_map(const std::filesystem::path& file);

// A tiled map reads its tiles when they are asked for, and keeps none. Any number of threads may
// use it at the same time.
class TiledMap {
 public:
  // Reads head and table. Throws std::runtime_error, which names the file and the error.
  explicit TiledMap(std::filesystem::path file);

  // Returns the roads of all tiles that meet the box; none if the map has none there. A box whose
  // west is greater than its east contains the 180th meridian. Throws std::runtime_error, which
  // names the file and the damaged tile, or if the tiles have more than `max_nodes` nodes.
  MapExtract read(const GeographicBox& box, std::size_t max_nodes = 50'000'000) const;

  // Returns the box around all tiles, degrees.
  GeographicBox area() const;
  const std::vector<TileEntry>& tiles() const { return table_.tiles; }

 private:
  std::filesystem::path file_;
  TileTable table_;
};

}  // namespace maploop::mapmatch
