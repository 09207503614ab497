// Writes the town's ground as a radar from space sees it, with the errors of SRTM.
#pragma once

#include <cstdint>
#include <filesystem>

#include "msgs/local_frame.h"
#include "tools/simulate/scene/ray_scene.h"
#include "tools/simulate/town/terrain.h"

namespace maploop::simulate {

struct GroundSetting {
  const World& world;
  const Terrain& terrain;
  Eigen::Vector2d least, most;  // m, enu, of what is built up
  const LocalFrame& frame;
  std::uint64_t seed;
};

// Makes a tile of SRTM3 (three seconds of arc) in the folder: the mean height of what is seen from
// above around each sample, roofs included, above EGM96, with errors of 1.6 m that are the same
// everywhere, of 1.5 m that last for 5 km and of 2 m that last for 200 m (Rodriguez et al.,
// "A global assessment of the SRTM performance", PE&RS 72, 2006: altogether 3.8 m in Eurasia). It
// is void farther than 3 km from what is built up. Throws std::runtime_error naming a file that
// cannot be written, or the geoid's grid (ppp/heights/height_model.h) where it is not installed.
void write_height_tile(const std::filesystem::path& folder, const GroundSetting& setting);

}  // namespace maploop::simulate
