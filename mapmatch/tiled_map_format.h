// These are the parts of the file of a tiled map.
//
// A tile is 0.05 degrees wide and high, and holds every way that touches it, whole. Ways of several
// tiles are in each of them. The file consists of archives (msgs/archive.h), each with its own
// checksum: a head, the tiles, and the table that tells where each tile is.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "mapmatch/network_builder.h"
#include "msgs/archive.h"

namespace maploop::mapmatch {

constexpr double tile_size = 0.05;  // degrees

// Tells which tile it is.
struct TilePlace {
  std::int32_t row = 0;     // from 90 degrees south to the north
  std::int32_t column = 0;  // from 180 degrees west to the east

  auto operator<=>(const TilePlace&) const =
      default;  // NOLINT(modernize-use-nullptr): it takes a generated 0 for a pointer
};

// Returns the tile that contains a place (degrees).
TilePlace tile_at(double latitude, double longitude);

// This is a node of a way in a tile.
struct TiledNode {
  static constexpr std::int32_t nowhere = std::numeric_limits<std::int32_t>::max();

  static constexpr double per_degree = 1e7;  // of latitude and longitude

  std::int64_t id = 0;              // OpenStreetMap's
  std::int32_t latitude = nowhere;  // `nowhere`: the map lacks this node
  std::int32_t longitude = 0;

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

  TilePlace place;
  std::vector<TiledWay> ways;
  std::vector<MapRestriction> restrictions;  // over a node in this tile

  void archive(auto& ar) {
    ar.section(section, version);
    ar(place.row, place.column, ways, restrictions);
  }
};

// Returns a part of the file as it is written.
template <class Part>
Bytes sealed(const Part& part) {
  ArchiveWriter writer;
  writer(part);
  return seal(writer.content());
}

// Adds the roads of a tile, whose nodes may be there already.
void append(MapExtract& map, const Tile& tile);
// Sorts nodes, ways and restrictions, and keeps each of them once.
void sort_once(MapExtract& map);

// Tells where in the file a tile is.
struct TileEntry {
  TilePlace place;
  std::uint64_t offset = 0, size = 0;  // bytes

  void archive(auto& ar) { ar(place.row, place.column, offset, size); }
};

struct TileTable {
  static constexpr std::string_view section = "table of tiles";
  static constexpr std::uint32_t version = 1;

  std::vector<TileEntry> tiles;  // by place, and in this order in the file
  std::uint64_t ways = 0, nodes = 0, restrictions = 0, restrictions_over_ways = 0;
  // Links with an opposite carriageway on this side (one_way_check.h), of all tiles.
  std::uint64_t to_left = 0, to_right = 0;

  void archive(auto& ar) {
    ar.section(section, version);
    ar(tiles, ways, nodes, restrictions, restrictions_over_ways, to_left, to_right);
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

}  // namespace maploop::mapmatch
