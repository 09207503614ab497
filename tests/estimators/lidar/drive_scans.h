#pragma once

#include <vector>

#include "sensors/replay/kitti_drive.h"
#include "tests/support/real_data.h"

namespace maploop::testing {

// The first `count` scans of a drive; all where there are fewer.
inline std::vector<LidarScan> read_scans(const sensors::KittiDrive& drive, std::size_t count) {
  std::vector<LidarScan> scans;
  const auto velodyne = drive.velodyne();
  for (LidarScan scan; scans.size() < count && velodyne->next(scan);) scans.push_back(scan);
  return scans;
}

}  // namespace maploop::testing
