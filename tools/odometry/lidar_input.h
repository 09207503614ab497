// Opens the input of a LiDAR odometry that runs alone.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "runtime/vehicle/drivers/recording.h"
#include "sensors/cloud/scan_folder.h"
#include "tools/odometry/lidar_run.h"
#include "tools/odometry/odometry_input.h"

namespace maploop::odometry {

// How the scans are used; without a seed, it is that of the input.
struct LidarUse {
  std::optional<LidarSeed> seed;
  std::size_t every = 1;
  FrameRange frames;
};

// A recording; one without a pair of cameras has the path of the scanner. Or a folder of scans,
// whose body is the scanner too, and whose stamps may be in a file.
class LidarInput {
 public:
  // Throws std::runtime_error naming the input and what it lacks.
  LidarInput(const InputFiles& files, const std::filesystem::path& stamps, const LidarUse& use);

  // Begins anew.
  LidarRun run(Method method);

  bool is_drive() const { return images_; }
  std::string remarks() const { return scans_ ? scans_->remarks() : ""; }

  Eigen::Isometry3d T_body_velo = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  LidarRunParameters parameters;

 private:
  vehicle::Recording recording_;
  bool images_ = false;
  std::filesystem::path folder_, stamps_;
  std::shared_ptr<sensors::ScanFolder> scans_;
};

}  // namespace maploop::odometry
