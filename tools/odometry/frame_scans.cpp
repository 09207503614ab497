#include "tools/odometry/frame_scans.h"

#include <stdexcept>

namespace maploop::odometry {

FrameScans::FrameScans(const sensors::KittiDrive& drive) : velodyne_(drive.velodyne()) {
  if (!drive.has_velodyne())
    throw std::runtime_error(
        "the drive has no folder velodyne_points: there is nothing for LiDAR "
        "odometry; leave --lidar and --disparity lidar out");
}

const LidarScan* FrameScans::of(std::size_t frame) {
  while (!ended_ && (!loaded_ || scan_.sequence < frame)) {
    loaded_ = velodyne_->next(scan_);
    ended_ = !loaded_;
  }
  return loaded_ && scan_.sequence == frame ? &scan_ : nullptr;
}

}  // namespace maploop::odometry
