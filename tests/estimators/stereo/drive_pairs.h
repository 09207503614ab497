#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "sensors/replay/kitti_drive.h"

namespace maploop::testing {

// Reads the first `count` pairs of a drive, or all if it has fewer.
inline std::vector<StereoPair> read_pairs(
    const sensors::KittiDrive& drive, std::size_t count = std::numeric_limits<std::size_t>::max()) {
  std::vector<StereoPair> pairs;
  const auto camera = drive.camera();
  for (StereoPair pair; pairs.size() < count && camera->next(pair);) pairs.push_back(pair);
  return pairs;
}

}  // namespace maploop::testing
