// Writes what cameras and LiDAR see at a frame.
#pragma once

#include <cstddef>
#include <filesystem>

#include "tools/simulate/drive.h"

namespace maploop::simulate {

// For one thread; any number of them may share a drive.
class FrameWriter {
 public:
  // Into image_00, image_01 and velodyne_points below `folder`, which are there. The drive must
  // outlive it.
  FrameWriter(const Drive& drive, std::filesystem::path folder, const SimulationOptions& options);

  void write(std::size_t frame);

 private:
  void write_images(std::size_t frame, std::uint64_t seed);
  void write_turn(std::size_t frame, std::uint64_t seed);

  const Drive& drive_;
  std::filesystem::path folder_;
  std::uint64_t seed_;
  SimulatedSensors sensors_;
  LidarParameters lidar_;
  bool compact_;
  RayScene scene_;
};

}  // namespace maploop::simulate
