// Finds the scan that belongs to each image pair of a drive.
#pragma once

#include <cstddef>
#include <memory>

#include "msgs/lidar_scan.h"
#include "sensors/replay/kitti_drive.h"

namespace maploop::odometry {

class FrameScans {
 public:
  // Throws std::runtime_error if the drive has no scans.
  explicit FrameScans(const sensors::KittiDrive& drive);

  // Returns the scan of this frame, or null if the drive does not have it. Frames must be requested
  // in ascending order. The scan is valid until the next call.
  const LidarScan* of(std::size_t frame);

 private:
  std::unique_ptr<sensors::Source<LidarScan>> velodyne_;
  LidarScan scan_;
  bool loaded_ = false;
  bool ended_ = false;
};

}  // namespace maploop::odometry
