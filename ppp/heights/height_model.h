// The height of the ground above the ellipsoid, from tiles of SRTM and a grid of its geoid.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "msgs/local_frame.h"
#include "ppp/heights/geoid_grid.h"
#include "ppp/heights/height_tile.h"
#include "ppp/heights/height_use.h"

namespace maploop::ppp {

// The ground at one place.
struct Ground {
  HeightUse use = HeightUse::no_tile;               // used: there is a height
  double height = 0.0;                              // m
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  // to the east and to the north, m/m
};

// Any number of threads may use it. A tile is read when the first place on it is asked for, which
// takes tens of milliseconds; at most four are kept, of 3 MB (SRTM3) or 26 MB (SRTM1).
class HeightModel {
 public:
  // `path` is a tile or a folder of tiles, `geoid` a grid of what their heights count from. Without
  // one (empty) it is EGM96 where Debian's proj-data is installed. If `geoid` is "none", heights
  // are above the ellipsoid. Throws FileError: no tile; a single tile or a grid that cannot be
  // read. A tile of a folder that cannot be read is found out later: see problems().
  HeightModel(const std::filesystem::path& path, const std::filesystem::path& geoid);

  Ground at(const Geodetic& place) const;

  // Returns whether heights are above the ellipsoid; without a grid of the geoid they are apart by
  // up to 110 m.
  bool above_ellipsoid() const { return ellipsoidal_ || geoid_.has_value(); }
  std::size_t tile_count() const { return files_.size(); }
  // Returns what was wrong with tiles so far.
  std::vector<std::string> problems() const;

  // The grid of EGM96 that is used if it is installed.
  static constexpr const char* usual_geoid = "/usr/share/proj/egm96_15.gtx";

 private:
  // nullptr: it cannot be read.
  using Tile = std::shared_ptr<const HeightTile>;

  Tile tile(TileCorner corner, const std::filesystem::path& file) const;

  std::map<TileCorner, std::filesystem::path> files_;
  std::optional<GeoidGrid> geoid_;
  bool ellipsoidal_ = false;

  mutable std::mutex mutex_;       // for what follows
  mutable std::list<Tile> tiles_;  // the last used first
  mutable std::map<TileCorner, std::string> problems_;
};

}  // namespace maploop::ppp
