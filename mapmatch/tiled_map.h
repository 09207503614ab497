// A tiled map holds the roads of a country in one file, of which only the tiles near the vehicle
// are read. Each tile has its own checksum: a damaged one is refused, and the others remain
// readable. tiled_map_format.h describes the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"
#include "mapmatch/tiled_map_format.h"

namespace maploop::mapmatch {

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
  // Returns where the tiles are, by place.
  const std::vector<TileEntry>& tiles() const { return table_.tiles; }

 private:
  std::filesystem::path file_;
  TileTable table_;
};

}  // namespace maploop::mapmatch
