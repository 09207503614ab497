// Runs LiDAR odometry alone, one motion for each frame.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "estimators/lidar/scan_preparation.h"
#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"
#include "sensors/cloud/scan_folder.h"
#include "tools/odometry/registration_method.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// The initial motion of a scan's registration.
enum class LidarSeed : std::uint8_t { vo, motion, none };
constexpr std::array<std::string_view, 3> names_of(LidarSeed) {
  return {"vo", "motion", "none"};
}

struct LidarRunParameters {
  stereo::StereoParameters stereo;
  lidar::LidarParameters lidar;
  LidarSeed seed = LidarSeed::vo;
  std::size_t every = 1;  // only each `every`-th scan is used, from the first frame on
  FrameRange frames;
  Method method = Method::gicp;
};

// What one step is made from; valid until the next.
struct LidarFrame {
  std::size_t number = 0;
  const LidarScan* scan = nullptr;     // raw; nullptr: none was taken, or it is not used
  std::optional<VisualMotion> visual;  // of the image pair taken during the scan
};
// Fills the next frame; returns false at the end.
using LidarFrames = std::function<bool(LidarFrame*)>;

// Returns the image pairs of a recording, each with the scan taken during the same turn if there is
// one. Without a visual seed their motion has only the stamp. Throws std::runtime_error if it has
// no images or no scans.
LidarFrames drive_frames(const vehicle::Recording& recording, const LidarRunParameters& parameters);
LidarFrames scan_frames(const std::shared_ptr<sensors::Source<LidarScan>>& scans,
                        const LidarRunParameters& parameters);

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
  // Throws std::runtime_error if the method is not available.
  LidarRun(LidarFrames frames, const Eigen::Isometry3d& T_body_velo,
           const LidarRunParameters& parameters);

  std::optional<LidarStep> next();

  // These are valid until the next step: what the last step was made from; the map.
  const LidarFrame& frame() const { return frame_; }
  const lidar::LocalMap& local_map() const { return odometer_.odometry().local_map(); }

 private:
  LidarFrames frames_;
  lidar::VisualLidarOdometer odometer_;
  LidarFrame frame_;
};

}  // namespace maploop::odometry
