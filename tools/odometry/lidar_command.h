// `maploop odometry DRIVE --lidar`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sensors/cloud/cloud_file.h"
#include "tools/odometry/lidar_run.h"
#include "tools/odometry/odometry_input.h"

namespace maploop::tools {

struct LidarOdometryOptions {
  bool wanted = false;
  std::optional<odometry::LidarSeed> seed;
  std::optional<sensors::CloudEncoding> encoding;
  std::size_t every = 1;
  std::vector<std::string> methods{"gicp"};
  std::filesystem::path stamps, truth, cloud, map, scans, html;
};

// Returns --lidar.
CLI::Option* add_lidar_options(CLI::App& odometry, LidarOdometryOptions& options);

// What visual odometry has as well.
struct OdometryFiles {
  odometry::InputFiles in;
  std::filesystem::path poses, tum, csv;
};

int lidar_odometry_alone(const LidarOdometryOptions& options, const OdometryFiles& files,
                         odometry::FrameRange frames);

}  // namespace maploop::tools
