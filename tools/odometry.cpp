// maploop odometry: one odometry alone, from images or from recorded tracks.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/vehicle_config.h"
#include "tools/commands.h"
#include "tools/evaluation/motion_chain.h"
#include "tools/evaluation/trajectory_file.h"
#include "tools/odometry/motion_csv.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::tools {
namespace {

struct OdometryOptions {
  std::filesystem::path input, config, poses, tum, csv;
  odometry::FrameRange frames;
};

// What there is to run, and where its camera sits.
struct Input {
  odometry::Run run;
  Eigen::Isometry3d T_body_cam;
  std::shared_ptr<const void> owner;  // of what the run reads
};

Input open_drive(const OdometryOptions& options) {
  vehicle::VehicleConfig config;
  if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
  auto drive = std::make_shared<const sensors::KittiDrive>(options.input, config.replay);
  return {odometry::stereo_run(*drive, config.stereo, options.frames),
          drive->calibration().stereo.T_body_cam, drive};
}

Input open_tracks(const OdometryOptions& options) {
  const stereo::StereoParameters parameters =
      options.config.empty() ? odometry::for_recorded_tracks()
                             : vehicle::load_vehicle_config(options.config).stereo;
  auto tracks = std::make_shared<const odometry::RecordedTracks>(
      odometry::read_recorded_tracks(options.input));
  return {odometry::tracks_run(tracks, parameters, options.frames), tracks->calibration.T_body_cam,
          tracks};
}

double percentile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

void print_summary(const std::vector<odometry::Step>& steps,
                   const evaluation::StampedTrajectory& trajectory) {
  std::map<std::string_view, int> by_status;
  std::vector<double> milliseconds;
  double way = 0.0;
  for (const odometry::Step& step : steps) {
    ++by_status[to_string(step.motion.status)];
    milliseconds.push_back(step.milliseconds);
    way += step.motion.translation.norm();
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  std::cout << "frames " << steps.front().frame << " to " << steps.back().frame << ", "
            << to_seconds(trajectory.stamps.back() - trajectory.stamps.front()) << " s, " << way
            << " m\n";
  for (const auto& [status, count] : by_status)
    std::cout << "  " << status << ": " << count << '\n';
  std::cout << "time a frame: median " << percentile(milliseconds, 0.5) << " ms, p99 "
            << percentile(milliseconds, 0.99) << " ms, largest " << milliseconds.back() << " ms\n";
}

int odometry_alone(const OdometryOptions& options) {
  const Input input =
      std::filesystem::is_directory(options.input) ? open_drive(options) : open_tracks(options);
  std::vector<odometry::Step> steps;
  evaluation::StampedTrajectory trajectory;  // of the camera, in its first frame
  evaluation::MotionChain chain;
  while (const auto step = input.run()) {
    steps.push_back(*step);
    trajectory.stamps.push_back(step->motion.stamp);
    trajectory.poses.push_back(input.T_body_cam.inverse() * chain.add(step->motion) *
                               input.T_body_cam);
  }
  if (steps.empty())
    throw std::runtime_error(options.input.string() +
                             " has no frame between --first and --last that can be read");
  if (!options.poses.empty()) evaluation::write_kitti_poses(options.poses, trajectory.poses);
  if (!options.tum.empty()) evaluation::write_tum(options.tum, trajectory);
  if (!options.csv.empty()) odometry::write_csv(options.csv, steps);
  print_summary(steps, trajectory);
  return 0;
}

}  // namespace

void add_odometry(CLI::App& app, Command& command) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* sub = app.add_subcommand(
      "odometry", "Visual odometry alone, from a drive's images or from recorded tracks");
  sub->add_option("DRIVE", options->input,
                  "Folder of a KITTI raw drive, or recorded tracks (<drive>.csv[.gz] with its "
                  "<drive>.meta.json)")
      ->required()
      ->check(CLI::ExistingPath);
  sub->add_option("--config", options->config,
                  "TOML file of parameters; without it recorded tracks get lower thresholds")
      ->check(CLI::ExistingFile);
  sub->add_option("--first", options->frames.first, "Number of the first frame");
  sub->add_option("--last", options->frames.last, "Number of the last frame");
  sub->add_option("--poses", options->poses,
                  "Write the left camera's poses to this file in KITTI's format");
  sub->add_option("--tum", options->tum, "The same in TUM's format, with stamps");
  sub->add_option("--csv", options->csv, "Write every motion to this file, one line a frame");
  sub->callback([options, &command] { command = [options] { return odometry_alone(*options); }; });
}

}  // namespace maploop::tools
