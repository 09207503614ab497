#include "tools/odometry/lidar_command.h"

#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/odometry/lidar_csv.h"
#include "tools/odometry/lidar_page.h"
#include "tools/odometry/point_cloud.h"

namespace maploop::tools {
namespace {

using odometry::LidarSeed;
using odometry::LidarStep;

}  // namespace

CLI::Option* add_lidar_options(CLI::App& odometry, LidarOdometryOptions& options) {
  CLI::Option* lidar = odometry.add_flag("--lidar", options.wanted,
                                         "LiDAR odometry instead, from the drive's scans");
  const std::map<std::string, LidarSeed> seeds{
      {"vo", LidarSeed::vo}, {"motion", LidarSeed::motion}, {"none", LidarSeed::none}};
  odometry
      .add_option_function<std::string>(
          "--seed", [&options, seeds](const std::string& name) { options.seed = seeds.at(name); },
          "What the registration of a scan starts from: visual odometry (vo), the motion before "
          "(motion), or the pose before (none)")
      ->check(CLI::IsMember({"vo", "motion", "none"}))
      ->needs(lidar);
  odometry.add_option("--every", options.every, "Use one scan of so many")
      ->check(CLI::Range(1, 1000))
      ->needs(lidar);
  odometry
      .add_option("--cloud", options.cloud,
                  "Write the surfaces of all scans to this file, .ply or .pcd")
      ->needs(lidar)
      ->check(writable_file());
  odometry.add_option("--html", options.html, "Write a page with a picture of them to this file")
      ->needs(lidar)
      ->check(writable_file());
  return lidar;
}

int lidar_odometry_alone(const LidarOdometryOptions& options, const OdometryFiles& files,
                         odometry::FrameRange frames) {
  if (!std::filesystem::is_directory(files.drive))
    throw std::runtime_error("'" + files.drive.string() +
                             "' is no folder of a drive, and recorded tracks have no scans");
  if (!options.cloud.empty()) odometry::check_cloud_name(options.cloud);
  vehicle::VehicleConfig config;
  if (!files.config.empty()) config = vehicle::load_vehicle_config(files.config);
  const auto drive = vehicle::open_drive(files.drive, config);
  describe_car(config, drive->calibration());
  const Eigen::Isometry3d T_body_cam = drive->calibration().stereo.T_body_cam;
  odometry::LidarRun run(*drive,
                         {config.stereo, config.lidar, options.seed, options.every, frames});
  std::optional<odometry::PointCloud> cloud;
  if (!options.cloud.empty() || !options.html.empty())
    cloud.emplace(drive->calibration().T_body_velo, config.lidar);

  std::vector<LidarStep> steps;
  evaluation::StampedTrajectory trajectory;  // of the camera, in its first frame
  while (const auto step = run.next()) {
    steps.push_back(*step);
    trajectory.stamps.push_back(step->odometry.stamp);
    trajectory.poses.push_back(T_body_cam.inverse() * step->pose * T_body_cam);
    if (cloud && step->with_scan && step->lidar.status == OdometryStatus::ok) {
      const RelativeMotion& m = step->lidar;
      cloud->add(run.scan(), m.stamp, lidar::Twist::of(m.T_from_to(), to_seconds(m.stamp - m.from)),
                 step->pose);
    }
  }
  if (steps.empty())
    throw std::runtime_error(files.drive.string() +
                             " has no frame between --first and --last that can be read");
  if (!files.poses.empty()) evaluation::write_kitti_poses(files.poses, trajectory.poses);
  if (!files.tum.empty()) evaluation::write_tum(files.tum, trajectory);
  if (!files.csv.empty()) odometry::write_lidar_csv(files.csv, steps);
  if (!options.cloud.empty()) cloud->write(options.cloud);
  if (!options.html.empty())
    evaluation::write_text(
        options.html, odometry::lidar_page("LiDAR odometry on " + files.drive.filename().string(),
                                           steps, *cloud));
  std::cout << odometry::summary(steps);
  if (cloud) std::cout << "cloud: " << cloud->size() << " points\n";
  return 0;
}

}  // namespace maploop::tools
