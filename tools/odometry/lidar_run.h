// Runs visual-LiDAR odometry alone, one motion for each frame.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "estimators/lidar/lidar_odometry.h"
#include "estimators/lidar/parameters.h"
#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"
#include "sensors/replay/kitti_drive.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// The initial motion of a scan's registration.
enum class LidarSeed : std::uint8_t { vo, motion, none };

struct LidarRunParameters {
  stereo::StereoParameters stereo;
  lidar::LidarParameters lidar;
  LidarSeed seed = LidarSeed::vo;
  std::size_t every = 1;  // only each `every`-th scan is used, from the first frame on
  FrameRange frames;
};

// The result for one frame: an image pair, and the scan taken during the same turn if there is one.
struct LidarStep {
  std::size_t frame = 0;
  bool with_scan = false;
  LidarMotion lidar;
  RelativeMotion odometry;    // the published motion of visual and LiDAR odometry
  Eigen::Isometry3d pose;     // of the body, in its first frame
  double milliseconds = 0.0;  // of processor time, with preparation, without visual odometry
};

class LidarRun {
 public:
  // `drive` must outlive the run. Throws std::runtime_error if it has no scans.
  LidarRun(const sensors::KittiDrive& drive, const LidarRunParameters& parameters);
  ~LidarRun();

  std::optional<LidarStep> next();

  // Returns the raw scan of the previous step; valid only if that step was with a scan.
  const LidarScan& scan() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace maploop::odometry
