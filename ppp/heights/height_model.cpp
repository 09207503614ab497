#include "ppp/heights/height_model.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"
#include "msgs/input_file.h"

namespace maploop::ppp {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_tiles = 4;          // those around a place where four meet
constexpr double metres_a_degree = 111'195.0;  // of latitude, on a sphere of the earth's size

std::map<TileCorner, fs::path> tiles_in(const fs::path& folder) {
  std::map<TileCorner, fs::path> files;
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    found.push_back(at->path());
  }
  if (error) throw FileError(folder, "cannot be listed: " + error.message());
  std::sort(found.begin(), found.end());  // of a tile that is there twice, the first counts
  for (const fs::path& file : found) {
    if (const auto corner = corner_of(file)) files.emplace(*corner, file);
  }
  if (files.empty()) {
    throw FileError(folder,
                    "the folder has no tiles of heights: files such as N49E011.hgt, .hgt.gz or "
                    ".hgt.zip are needed");
  }
  return files;
}

}  // namespace

HeightModel::HeightModel(const fs::path& path, const fs::path& geoid) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    files_ = tiles_in(path);
  } else {
    tiles_.push_back(std::make_shared<const HeightTile>(read_height_tile(path)));
    files_.emplace(tiles_.front()->corner(), path);
  }
  ellipsoidal_ = geoid == "none";
  if (ellipsoidal_) return;
  const fs::path grid = geoid.empty() ? fs::path(usual_geoid) : geoid;
  if (!geoid.empty() || fs::exists(grid, ignored)) geoid_ = read_geoid_grid(grid);
}

HeightModel::Tile HeightModel::tile(TileCorner corner, const fs::path& file) const {
  const std::lock_guard lock(mutex_);
  const auto at = std::find_if(tiles_.begin(), tiles_.end(),
                               [&](const Tile& t) { return t->corner() == corner; });
  if (at != tiles_.end()) {
    tiles_.splice(tiles_.begin(), tiles_, at);
    return tiles_.front();
  }
  if (problems_.contains(corner)) return nullptr;
  try {
    tiles_.push_front(std::make_shared<const HeightTile>(read_height_tile(file)));
  } catch (const FileError& e) {
    problems_.emplace(corner, e.what());
    return nullptr;
  }
  if (tiles_.size() > kept_tiles) tiles_.pop_back();
  return tiles_.front();
}

Ground HeightModel::at(const Geodetic& place) const {
  const double latitude = degrees(place.latitude), longitude = degrees(place.longitude);
  if (!std::isfinite(latitude) || !std::isfinite(longitude)) return {};
  const TileCorner corner{static_cast<int>(std::floor(latitude)),
                          static_cast<int>(std::floor(longitude))};
  const auto file = files_.find(corner);
  if (file == files_.end()) return {};
  double geoid = 0.0;
  if (geoid_) {
    const auto height = geoid_->at(latitude, longitude);
    if (!height) return {};
    geoid = *height;
  }
  const Tile tile = this->tile(corner, file->second);
  if (!tile) return {.use = HeightUse::unreadable};
  const auto height = tile->at(latitude, longitude);
  if (!height) return {.use = HeightUse::no_height};
  const double east = metres_a_degree * std::max(std::cos(place.latitude), 1e-3);
  return {HeightUse::used,
          height->height + geoid,
          {height->per_longitude / east, height->per_latitude / metres_a_degree}};
}

std::vector<std::string> HeightModel::problems() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> texts;
  for (const auto& [corner, text] : problems_) texts.push_back(text);
  return texts;
}

}  // namespace maploop::ppp
