// This file reads the scans of a KITTI drive.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/replay/timestamps.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Parses the points of a scan file: four little-endian float32 each (x, y, z in m, reflectance).
// Points with a value that is not finite are dropped; returns how many. Throws std::runtime_error
// whose text is the reason only: empty, not a multiple of 16 bytes, no finite point.
std::size_t parse_velodyne_points(const std::vector<char>& bytes, std::vector<LidarPoint>& points);

// This is the folder of the numbered scans (.bin, or packed_scan.h's .scan), with the stamps at
// which each turn began, faced forward and ended.
struct VelodyneFolder {
  std::filesystem::path data;
  Timestamps start, middle, end;
};

// LidarScan has stamp = middle, available = end. A scan is refused unless its stamps are start <
// middle < end within `max_turn`. The points of scans available up to `passed` are not read.
std::unique_ptr<Source<LidarScan>> make_velodyne_source(VelodyneFolder folder, Duration max_turn,
                                                        Time passed = Time::min());

}  // namespace maploop::sensors
