// The scan that belongs to each image pair of a drive.
#pragma once

#include <cstddef>
#include <memory>

#include "msgs/lidar_scan.h"
#include "sensors/replay/kitti_drive.h"

namespace maploop::odometry {

class FrameScans {
 public:
  // Throws std::runtime_error where the drive has no scans.
  explicit FrameScans(const sensors::KittiDrive& drive);

  // The scan of this frame; null where the drive lacks it. Frames are asked for in ascending order.
  // Valid until the next call.
  const LidarScan* of(std::size_t frame);

 private:
  std::unique_ptr<sensors::Source<LidarScan>> velodyne_;
  LidarScan scan_;
  bool loaded_ = false;
  bool ended_ = false;
};

}  // namespace maploop::odometry
