// maploop odometry: one odometry alone, from images or from recorded tracks.
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/recorded_tracks.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/odometry/lidar_command.h"
#include "tools/odometry/motion_csv.h"
#include "tools/odometry/odometry_input.h"
#include "tools/odometry/stereo_figures.h"
#include "tools/odometry/summary.h"
#include "tools/odometry/track_writer.h"

namespace maploop::tools {
namespace {

struct OdometryOptions {
  OdometryFiles files;
  std::filesystem::path tracks, json;
  odometry::FrameRange frames;
  std::optional<stereo::Matching> matching;
  std::optional<stereo::MotionMethod> motion;
  std::optional<int> window_frames;
  std::optional<odometry::Disparities> disparities;
  LidarOdometryOptions lidar;
};

void adjust(const OdometryOptions& options, stereo::StereoParameters& parameters) {
  if (options.matching) parameters.matching = *options.matching;
  if (options.motion) parameters.motion = *options.motion;
  if (options.motion == stereo::MotionMethod::image_to_image) parameters.window_frames = 0;
  if (options.window_frames) parameters.window_frames = *options.window_frames;
}

odometry::RecordedTracks recorded(const StereoCalibration& camera,
                                  const std::vector<odometry::Step>& steps) {
  odometry::RecordedTracks result;
  result.calibration = camera;
  result.first_good_frame = steps.front().frame;
  result.frames.resize(steps.back().frame + 1);
  result.stamps.resize(result.frames.size(), steps.front().motion.stamp);
  std::map<Time, std::size_t> frame_at;
  for (const odometry::Step& step : steps) {
    result.stamps[step.frame] = step.motion.stamp;
    frame_at[step.motion.stamp] = step.frame;
    if (!step.tracks.empty()) result.add(frame_at.at(step.motion.from), step.frame, step.tracks);
  }
  return result;
}

int odometry_alone(const OdometryOptions& options) {
  if (options.lidar.wanted) {
    return lidar_odometry_alone(options.lidar, options.files, options.frames);
  }
  const odometry::Input input = odometry::open_input(
      options.files.in, options.frames, options.disparities.value_or(odometry::Disparities::own),
      [&options](stereo::StereoParameters& parameters) { adjust(options, parameters); });
  std::optional<evaluation::StampedTrajectory> truth;
  if (!options.json.empty()) {
    truth = options.lidar.truth.empty() ? odometry::read_truth(options.files.in)
                                        : evaluation::read_trajectory(options.lidar.truth);
  }
  std::vector<odometry::Step> steps;
  odometry::CameraPath path(input.camera.T_body_cam);
  Progress progress("frames");
  while (auto step = input.run()) {
    progress.at(static_cast<double>(steps.size()));
    if (truth && options.motion == stereo::MotionMethod::image_to_image &&
        step->motion.status == OdometryStatus::ok)
      odometry::give_true_length(input.camera, *truth, step->motion);
    path.add(step->motion);
    steps.push_back(std::move(*step));
  }
  const evaluation::StampedTrajectory& trajectory = path.trajectory();
  if (steps.empty()) {
    throw std::runtime_error(options.files.in.input.string() +
                             " has no frame between --first and --last that can be read");
  }
  if (!options.files.poses.empty())
    evaluation::write_kitti_poses(options.files.poses, trajectory.poses);
  if (!options.files.tum.empty()) evaluation::write_tum(options.files.tum, trajectory);
  if (!options.files.csv.empty()) odometry::write_csv(options.files.csv, steps);
  if (!options.tracks.empty())
    odometry::write_recorded_tracks(options.tracks, recorded(input.camera, steps));
  if (truth) {
    write_json_file(options.json,
                    odometry::stereo_figures(steps, trajectory, input.camera, *truth));
  }
  std::cout << odometry::summary(steps);
  return 0;
}

}  // namespace

void add_odometry(CLI::App& app, Command& command) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* sub = app.add_subcommand(
      "odometry", "Visual odometry alone, from recorded images or tracks; or LiDAR odometry");
  sub->add_option("DRIVE", options->files.in.input,
                  "A KITTI raw drive, a bag or whatever else with images maploop replay takes, or "
                  "recorded tracks (<drive>.csv[.gz] with its <drive>.meta.json); with --lidar "
                  "also a recording with scans alone, or a folder of scans")
      ->required()
      ->check(existing_path());
  sub->add_option("--config", options->files.in.config,
                  "TOML file of parameters; without it recorded tracks get lower thresholds")
      ->check(existing_file());
  add_topics(sub, options->files.in.topics);
  sub->add_option("--first", options->frames.first, "Number of the first frame")
      ->check(whole_number());
  sub->add_option("--last", options->frames.last, "Number of the last frame")
      ->check(whole_number());
  sub->add_option("--poses", options->files.poses,
                  "Write the left camera's poses to this file in KITTI's format")
      ->check(writable_file());
  sub->add_option("--tum", options->files.tum, "The same in TUM's format, with stamps")
      ->check(writable_file());
  sub->add_option("--csv", options->files.csv, "Write every motion to this file, one line a frame")
      ->check(writable_file());
  CLI::Option* lidar = add_lidar_options(*sub, options->lidar);
  add_choice(sub, "--matching", options->matching,
             "How features are found again: klt or sift, in place of the configuration's")
      ->excludes(lidar);
  add_choice(sub, "--motion", options->motion,
             "How the motion is found: 3d-2d, 3d-3d or 2d-2d (left camera alone, length unknown)")
      ->excludes(lidar);
  sub->add_option("--window", options->window_frames,
                  "Poses that are adjusted together, 3 to 12; 0: from pair to pair only")
      ->excludes(lidar);
  add_choice(sub, "--disparity", options->disparities,
             "Who says what all disparities lack: none, the image pairs (own), or they and "
             "LiDAR odometry (lidar)")
      ->excludes(lidar);
  sub->add_option("--tracks", options->tracks,
                  "Write the features followed to this file (.csv or .csv.gz) and its .meta.json, "
                  "which can be read in place of a drive")
      ->check(writable_file())
      ->excludes(lidar);
  sub->add_option("--json", options->json,
                  "Write figures against the truth to this file; motions of 2d-2d get the truth's "
                  "lengths")
      ->check(writable_file())
      ->excludes(lidar);
  sub->callback([options, &command] {
    if (!options->lidar.truth.empty() && options->json.empty() && !options->lidar.wanted)
      throw CLI::RequiredError("--truth scores --json or --lidar: one of them");
    command = [options] { return odometry_alone(*options); };
  });
}

}  // namespace maploop::tools
