// Visual-LiDAR odometry alone, one motion a scan.
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

// What the registration of a scan starts from.
enum class LidarSeed : std::uint8_t { vo, motion, none };

struct LidarRunParameters {
  stereo::StereoParameters stereo;
  lidar::LidarParameters lidar;
  LidarSeed seed = LidarSeed::vo;
  std::size_t every = 1;  // scan of so many is used, from the first frame on
  FrameRange frames;
};

// One frame: an image pair, and the scan taken at the same turn where there is one.
struct LidarStep {
  std::size_t frame = 0;
  bool with_scan = false;
  LidarMotion lidar;
  RelativeMotion odometry;    // the best of both
  Eigen::Isometry3d pose;     // of the body, in its first frame
  double milliseconds = 0.0;  // of processor time, preparation included, visual odometry not
};

class LidarRun {
 public:
  // `drive` must outlive the run. Throws std::runtime_error where it has no scans.
  LidarRun(const sensors::KittiDrive& drive, const LidarRunParameters& parameters);
  ~LidarRun();

  std::optional<LidarStep> next();

  // Of the step before, as it came; only where it was with a scan.
  const LidarScan& scan() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace maploop::odometry
