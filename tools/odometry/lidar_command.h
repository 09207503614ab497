// `maploop odometry DRIVE --lidar`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "tools/odometry/lidar_run.h"

namespace maploop::tools {

struct LidarOdometryOptions {
  bool wanted = false;
  odometry::LidarSeed seed = odometry::LidarSeed::vo;
  std::size_t every = 1;
  std::filesystem::path cloud, html;
};

// Returns --lidar.
CLI::Option* add_lidar_options(CLI::App& odometry, LidarOdometryOptions& options);

// What visual odometry has as well.
struct OdometryFiles {
  std::filesystem::path drive, config, poses, tum, csv;
};

int lidar_odometry_alone(const LidarOdometryOptions& options, const OdometryFiles& files,
                         odometry::FrameRange frames);

}  // namespace maploop::tools
