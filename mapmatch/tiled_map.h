// A tiled map holds the roads of a country in one file, of which only the tiles near the vehicle
// are read. Each tile has its own checksum: a damaged one is refused, and the others remain
// readable. tiled_map_format.h describes the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"
#include "mapmatch/tiled_map_format.h"
#include "msgs/local_frame.h"
#include "msgs/road_side.h"

namespace maploop::mapmatch {

// Returns whether the file begins as a tiled map.
bool is_tiled_map(const std::filesystem::path& file);

// A tiled map reads its tiles when they are asked for, and keeps none; the file stays open, so that
// another one may take its name. Any number of threads may use it at the same time.
class TiledMap {
 public:
  // Reads head and table. Throws std::runtime_error, which names the file and the error.
  explicit TiledMap(std::filesystem::path file);

  // Returns the tiles of the map that meet a box. A box whose west is greater than its east
  // contains the 180th meridian.
  std::set<TilePlace> tiles_within(const GeographicBox& box) const;
  // Returns the tiles of the map that are at most so many metres north, south, east or west of one
  // of the places.
  std::set<TilePlace> tiles_about(std::span<const Geodetic> places, double metres) const;
  // Returns the roads of these tiles; none if the map has none there. Throws std::runtime_error,
  // which names the file and the damaged tile, or if their ways have more than `max_nodes` nodes.
  MapExtract read(const std::set<TilePlace>& tiles, std::size_t max_nodes = 50'000'000) const;
  // Does the same for all tiles that meet the box; the default box is the whole map.
  MapExtract read(const GeographicBox& box = {}, std::size_t max_nodes = 50'000'000) const;

  // Returns the box around all tiles, degrees.
  GeographicBox area() const;
  // Returns the side of the traffic in most places of the map where it can be seen.
  RoadSide side_of_road() const;
  // Returns where the tiles are, and what they hold together.
  const TileTable& table() const { return table_; }

 private:
  std::vector<TileEntry>::const_iterator at_or_after(const TilePlace& place) const;

  std::filesystem::path file_;
  std::shared_ptr<const int> descriptor_;
  TileTable table_;
};

}  // namespace maploop::mapmatch
