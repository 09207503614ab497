// Writes the camera images and the LiDAR scan of a frame.
#pragma once

#include <cstddef>
#include <filesystem>

#include "tools/simulate/drive.h"

namespace maploop::simulate {

// An object belongs to one thread; any number of objects may share a drive.
class FrameWriter {
 public:
  // Writes into image_00, image_01 and velodyne_points below `folder`, which must exist. The drive
  // must outlive this object.
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
