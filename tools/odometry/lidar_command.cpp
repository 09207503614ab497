#include "tools/odometry/lidar_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "sensors/replay/files.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/odometry/comparison.h"
#include "tools/odometry/lidar_input.h"
#include "tools/odometry/lidar_page.h"
#include "tools/odometry/motion_csv.h"
#include "tools/odometry/point_cloud.h"
#include "tools/odometry/summary.h"

namespace maploop::tools {
namespace {

using evaluation::StampedTrajectory;
using odometry::LidarInput, odometry::LidarRun, odometry::LidarStep, odometry::Method;

// The camera's path in its first frame.
void add_pose(const LidarStep& step, const Eigen::Isometry3d& T_body_cam, StampedTrajectory* path) {
  path->stamps.push_back(step.odometry.stamp);
  path->poses.push_back(T_body_cam.inverse() * step.pose * T_body_cam);
}

[[noreturn]] void fail_without_frames(const OdometryFiles& files, const LidarInput& input) {
  throw std::runtime_error(files.in.input.string() +
                           " has no frame between --first and --last that can be read\n" +
                           input.remarks());
}

odometry::Compared run_method(Method method, LidarInput& input, const OdometryFiles& files,
                              const StampedTrajectory& truth) {
  LidarRun run = input.run(method);
  StampedTrajectory path;
  std::vector<double> times;
  double points = 0.0;
  int refused = 0;
  Progress progress("scans by " + std::string(to_string(method)));
  while (const auto step = run.next()) {
    progress.at(static_cast<double>(times.size()));
    add_pose(*step, input.T_body_cam, &path);
    if (!step->with_scan || step->lidar.status == OdometryStatus::first_frame) continue;
    times.push_back(step->milliseconds);
    points += step->lidar.tracked;
    refused += step->lidar.status != OdometryStatus::ok;
  }
  if (times.empty()) fail_without_frames(files, input);
  const evaluation::Evaluation score = odometry::scored(path, truth);
  const evaluation::SegmentError& turned = score.lengths.back().common_rotation_removed;
  return {
      {std::string(to_string(method)), odometry::percent_cell(turned),
       odometry::turning_cell(turned), fmt::format("{:.2f}", score.raw.end_point_m),
       fmt::format("{:.1f}", odometry::percentile(times, 0.5)),
       fmt::format("{:.1f}", odometry::percentile(times, 0.95)),
       fmt::format("{:.0f}", points / static_cast<double>(times.size())), std::to_string(refused)},
      score};
}

// Returns the methods of these names, where "all" names those that are available.
std::vector<Method> methods_of(const std::vector<std::string>& names) {
  const bool all = std::find(names.begin(), names.end(), "all") != names.end();
  std::vector<Method> methods;
  for (const std::string& name : all ? choices<Method>() : names) {
    const Method method = *value_named<Method>(name);
    if (!all || odometry::available(method)) methods.push_back(method);
  }
  return methods;
}

int compare(const LidarOdometryOptions& options, const OdometryFiles& files, LidarInput& input,
            const std::vector<Method>& methods) {
  for (const auto* file :
       {&files.poses, &files.tum, &files.csv, &options.cloud, &options.map, &options.scans}) {
    if (!file->empty()) {
      throw std::runtime_error("'" + file->string() +
                               "' is written by one method without --truth; name one");
    }
  }
  if (options.truth.empty() && !input.is_drive()) {
    throw std::runtime_error(
        "methods are scored against a truth, which a folder of scans does not "
        "have: name it with --truth");
  }
  const StampedTrajectory truth = options.truth.empty()
                                      ? odometry::read_truth(files.in)
                                      : evaluation::read_trajectory(options.truth);
  odometry::Comparison comparison{
      {"method", "100 m turned, %", "turned, deg/m", "end point, m", "ms a scan p50", "p95",
       "points", "refused"},
      "turned: with one common rotation between the truth's axes and the estimate's removed. All "
      "methods register the same samples of a scan with the same kind of local map and the same "
      "seed; gicp and point-to-plane use its normals, those of PCL its positions. Times are "
      "processor times of a scan with its preparation, of PCL also with that of the map."};
  for (const Method method : methods) {
    comparison.methods.push_back(run_method(method, input, files, truth));
  }
  std::cout << to_text(comparison) << input.remarks();
  if (!options.html.empty()) {
    evaluation::write_text(
        options.html,
        to_html(comparison, "LiDAR odometry on " + files.in.input.filename().string()));
  }
  return 0;
}

// What is written about a run of one method.
class Outputs {
 public:
  Outputs(const LidarOdometryOptions& options, const OdometryFiles& files, const LidarInput& input)
      : options_(options), files_(files), input_(input) {
    for (const auto* file : {&options.cloud, &options.map})
      if (!file->empty()) sensors::check_cloud_name(*file, encoding());
    if (!options.cloud.empty() || !options.html.empty())
      cloud_.emplace(input.T_body_velo, input.parameters.lidar);
    if (!options.scans.empty()) std::filesystem::create_directories(options.scans);
  }

  void add(const LidarStep& step, const LidarRun& run) {
    steps_.push_back(step);
    add_pose(step, input_.T_body_cam, &path_);
    if (!step.with_scan) return;
    if (!options_.scans.empty()) add_scan(run.frame());
    if (cloud_ && step.lidar.status == OdometryStatus::ok) {
      const RelativeMotion& m = step.lidar;
      cloud_->add(*run.frame().scan, m.stamp,
                  lidar::Twist::of(m.T_from_to(), to_seconds(m.stamp - m.from)), step.pose);
    }
  }

  void write(const LidarRun& run) const {
    if (steps_.empty()) fail_without_frames(files_, input_);
    if (!files_.poses.empty()) evaluation::write_kitti_poses(files_.poses, path_.poses);
    if (!files_.tum.empty()) evaluation::write_tum(files_.tum, path_);
    if (!files_.csv.empty()) odometry::write_csv(files_.csv, steps_);
    if (!options_.cloud.empty()) write_cloud(options_.cloud, odometry::table_of(cloud_->points()));
    const auto map = run.local_map().points();
    if (!options_.map.empty()) write_cloud(options_.map, odometry::table_of(map));
    if (!options_.scans.empty())
      evaluation::write_text(options_.scans / "timestamps.txt", scan_stamps_);
    if (!options_.html.empty()) {
      evaluation::write_text(
          options_.html,
          odometry::lidar_page("LiDAR odometry on " + files_.in.input.filename().string(), steps_,
                               *cloud_));
    }
    std::cout << odometry::summary(steps_);
    if (cloud_) std::cout << "cloud: " << cloud_->size() << " points\n";
    if (!options_.map.empty()) std::cout << "local map: " << map.size() << " points\n";
    std::cout << input_.remarks();
  }

 private:
  sensors::CloudEncoding encoding() const {
    return options_.encoding.value_or(sensors::CloudEncoding::binary);
  }

  void write_cloud(const std::filesystem::path& file, const sensors::CloudTable& table) const {
    evaluation::write_text(file, sensors::encode_cloud(table, file, encoding()));
  }

  void add_scan(const odometry::LidarFrame& frame) {
    write_cloud(options_.scans / sensors::numbered_file(frame.number, ".pcd"),
                odometry::table_of(*frame.scan));
    scan_stamps_ += format_time(frame.scan->stamp) + '\n';
  }

  const LidarOdometryOptions& options_;
  const OdometryFiles& files_;
  const LidarInput& input_;
  std::vector<LidarStep> steps_;
  StampedTrajectory path_;
  std::optional<odometry::PointCloud> cloud_;
  std::string scan_stamps_;
};

}  // namespace

CLI::Option* add_lidar_options(CLI::App& odometry, LidarOdometryOptions& options) {
  CLI::Option* lidar = odometry.add_flag(
      "--lidar", options.wanted,
      "LiDAR odometry instead, from the scans of a drive or of a folder of .pcd, .ply or KITTI's "
      ".bin files, whose poses are the scanner's");
  add_choice(
      &odometry, "--seed", options.seed,
      "What the registration of a scan starts from: visual odometry (vo; a drive's default), "
      "the motion before (motion), or the pose before (none)")
      ->needs(lidar);
  std::vector<std::string> methods = choices<Method>();
  methods.emplace_back("all");
  odometry
      .add_option("--method", options.methods,
                  "How a scan is registered with the local map: gicp, the vehicle's, or another; "
                  "several, with commas between, or all are compared in a table")
      ->delimiter(',')
      ->check(CLI::IsMember(methods))
      ->default_str("gicp")
      ->needs(lidar);
  const auto file = [&](const char* flag, std::filesystem::path& path, const char* what,
                        const CLI::Validator& check) {
    odometry.add_option(flag, path, what)->check(check)->needs(lidar);
  };
  odometry
      .add_option("--truth", options.truth,
                  "Score --json, or with --lidar that table, against this truth of the left camera "
                  "(TUM, KITTI, *.truth.csv); without it they are scored against the drive's own")
      ->check(existing_file());
  file("--stamps", options.stamps,
       "Stamps of a folder's scans, a line each: seconds, or YYYY-MM-DD hh:mm:ss.fraction; without "
       "it timestamps.txt in the folder, or 0.1 s apart",
       existing_file());
  odometry.add_option("--every", options.every, "Use one scan of so many")
      ->check(CLI::Range(1, 1000))
      ->needs(lidar);
  file("--cloud", options.cloud, "Write the surfaces of all scans to this file, .ply or .pcd",
       writable_file());
  file("--save-map", options.map, "Write the local map at the end to this file, .ply or .pcd",
       writable_file());
  file("--scans", options.scans,
       "Write the scans used to this folder, as .pcd with times, and their timestamps.txt",
       CLI::Validator());
  add_choice(&odometry, "--cloud-format", options.encoding,
             "How clouds are written: ascii, binary (default) or compressed (.pcd)")
      ->needs(lidar);
  file("--html", options.html, "Write a page with a picture of them to this file", writable_file());
  return lidar;
}

int lidar_odometry_alone(const LidarOdometryOptions& options, const OdometryFiles& files,
                         odometry::FrameRange frames) {
  LidarInput input(files.in, options.stamps, {options.seed, options.every, frames});
  const std::vector<Method> methods = methods_of(options.methods);
  if (methods.size() > 1 || !options.truth.empty()) return compare(options, files, input, methods);
  Outputs outputs(options, files, input);
  LidarRun run = input.run(methods.front());
  Progress progress("frames");
  double done = 0.0;
  while (const auto step = run.next()) {
    outputs.add(*step, run);
    progress.at(++done);
  }
  outputs.write(run);
  return 0;
}

}  // namespace maploop::tools
