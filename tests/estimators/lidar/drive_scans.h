#pragma once

#include <vector>

#include "estimators/lidar/parameters.h"
#include "sensors/replay/kitti_drive.h"
#include "tests/support/real_data.h"

namespace maploop::testing {

// Reads the first `count` scans of a drive, or all if it has fewer.
inline std::vector<LidarScan> read_scans(const sensors::KittiDrive& drive, std::size_t count) {
  std::vector<LidarScan> scans;
  const auto velodyne = drive.velodyne();
  for (LidarScan scan; scans.size() < count && velodyne->next(scan);) scans.push_back(scan);
  return scans;
}

// Returns parameters with the known calibration of the drive's scanner.
inline lidar::LidarParameters lidar_parameters(const sensors::KittiDrive& drive) {
  lidar::LidarParameters parameters;
  parameters.elevation_correction = drive.calibration().beam_elevation;
  return parameters;
}

}  // namespace maploop::testing
