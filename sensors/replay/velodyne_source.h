// The scans of a KITTI drive.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/replay/timestamps.h"
#include "sensors/source.h"

namespace maploop::sensors {

// The points of a scan file: four little-endian float32 each (x, y, z, reflectance). Points with a
// value that is not finite are dropped; returns how many. Throws std::runtime_error with the
// reason alone: empty, not a multiple of 16 bytes, no finite point.
std::size_t parse_velodyne_points(const std::vector<char>& bytes, std::vector<LidarPoint>& points);

// The folder of the numbered scans (.bin, or packed_scan.h's .scan), and the stamps of when the
// turn began, faced forward and ended.
struct VelodyneFolder {
  std::filesystem::path data;
  Timestamps start, middle, end;
};

// LidarScan: stamp = middle, available = end. A scan whose stamps are not start < middle < end
// within `max_turn` is refused.
// The points of scans available up to `passed` are not read.
std::unique_ptr<Source<LidarScan>> make_velodyne_source(VelodyneFolder folder, Duration max_turn,
                                                        Time passed = Time::min());

}  // namespace maploop::sensors
