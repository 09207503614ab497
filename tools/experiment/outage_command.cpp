// maploop experiment outages: drives of tables, from other cars than KITTI's. How the mount of the
// inertial unit is found, and how far the state is from the fixes that made outages take away.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/frames.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/table_recording.h"
#include "sensors/replay/sequence_files.h"
#include "tools/command/median.h"
#include "tools/command/option_checks.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/sequence_run.h"
#include "tools/experiment/table.h"
#include "tools/replay/run_pass.h"

namespace maploop::tools {
namespace {

using namespace experiments;
namespace fs = std::filesystem;

// Parameters are chosen on the first half, so that the other one scores them.
struct TableDrive {
  fs::path folder;
  const char* half;  // "odd" or "even", by the order of the names from 1
};

std::vector<TableDrive> drives_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (sensors::TableRecording::is_named(entry.path())) folders.push_back(entry.path());
  }
  if (folders.empty()) {
    throw std::runtime_error("no drive in '" + folder.string() +
                             "': it needs folders with gnss.csv (sensors/FORMATS.md)");
  }
  std::sort(folders.begin(), folders.end());
  std::vector<TableDrive> drives;
  for (const fs::path& f : folders) drives.push_back({f, drives.size() % 2 == 0 ? "odd" : "even"});
  return drives;
}

Eigen::Matrix3d rotation(double roll, double pitch, double yaw) {  // deg
  return (Eigen::AngleAxisd(radians(yaw), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(radians(pitch), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(radians(roll), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// Roll, pitch and yaw of R = Rz(yaw) Ry(pitch) Rx(roll), deg.
std::string angles(const Eigen::Matrix3d& R) {
  const double yaw = degrees(std::atan2(R(1, 0), R(0, 0)));
  return number(degrees(std::atan2(R(2, 1), R(2, 2))), 1) + " " +
         number(degrees(-std::asin(std::clamp(R(2, 0), -1.0, 1.0))), 1) + " " +
         number(yaw < 0.0 ? yaw + 360.0 : yaw, 1);
}

// How far the axes that point up, and those that point forward, are apart.
std::string apart(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::Matrix3d D = a * b.transpose();
  return number(degrees(std::acos(std::clamp(D(2, 2), -1.0, 1.0))), 1) + ", " +
         number(degrees(std::atan2(D(1, 0), D(0, 0))), 1);
}

// The last estimate of the receiver, a peer as well.
std::optional<Eigen::Matrix3d> receivers_mount(const fs::path& folder) {
  const auto file = sensors::existing_table(folder / "reference_mount.csv");
  if (!file) return std::nullopt;
  const sensors::NumberTable table(*file);
  if (table.size() == 0) return std::nullopt;
  const auto row = table.row(table.size() - 1);
  return rotation(row[table.column("roll_deg")], row[table.column("pitch_deg")],
                  row[table.column("yaw_deg")]);
}

Row mount_row(const TableDrive& drive) {
  const sensors::TableRecording recording(drive.folder);
  Row row{drive.half, drive.folder.filename().string()};
  if (!recording.has_imu()) return row;
  const auto imu = recording.imu(recording.gnss(), {}, sensors::TableRecording::cabin_ahead);
  const sensors::Mount& mount = imu->alignment().mount();
  ImuSample sample;
  if (!imu->next(sample)) {
    row.emplace_back("never");
    return row;
  }
  const Time found = sample.stamp;
  const Eigen::Matrix3d first = mount.R_body_unit;
  while (imu->next(sample)) {
  }
  const auto peer = receivers_mount(drive.folder);
  row.push_back(number(to_seconds(found - recording.first_stamp()), 0));
  row.push_back(angles(mount.R_body_unit));
  row.push_back(number(degrees(mount.level_sigma), 2) + ", " +
                number(degrees(mount.forward_sigma), 2));
  row.push_back(apart(first, mount.R_body_unit));
  row.push_back(peer ? angles(*peer) : "");
  row.push_back(peer ? apart(mount.R_body_unit, *peer) : "");
  return row;
}

Table mount_table(const std::vector<TableDrive>& drives) {
  Table table{"Mount of the unit: roll pitch yaw in degrees; differences of level, forward",
              {"half", "drive", "found s", "mount", "sigma", "first - last", "receiver's",
               "last - receiver's"},
              {}};
  for (const TableDrive& drive : drives) table.rows.push_back(mount_row(drive));
  return table;
}

struct OutageCase {
  TableDrive drive;
  std::string configuration;
  double length;  // s
};

// One outage after another; before the first one the filter has time to learn its sensors.
std::string made_outages(double duration, double length) {
  const double between = 60.0;
  const double begin = std::clamp(0.25 * duration, between, 150.0);  // s
  std::string text;
  for (double start = begin; start + length < duration; start += length + between) {
    text += (text.empty() ? "" : ",") + number(start, 1) + ":" + number(length, 1);
  }
  return text;
}

std::vector<fusion_score::OutageEnd> run(const OutageCase& c, vehicle::VehicleConfig config) {
  vehicle::fit_to_recording(config, c.drive.folder);
  set_configuration(config, c.configuration);
  const sensors::TableRecording tables(c.drive.folder);
  config.gnss_outage =
      made_outages(to_seconds(tables.last_stamp() - tables.first_stamp()), c.length);
  if (config.gnss_outage.empty()) return {};
  const RecordingRun run = run_recording(vehicle::open_recording(c.drive.folder, config), config);
  return outage_ends(run.track, run.recording, run.reference);
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

Table outage_table(const std::vector<OutageCase>& cases,
                   const std::vector<std::vector<fusion_score::OutageEnd>>& results,
                   bool by_drive) {
  constexpr double least_way = 50.0;  // m: a standing car shows nothing
  Groups<std::vector<fusion_score::OutageEnd>> groups;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const fusion_score::OutageEnd& end : results[i]) {
      const OutageCase& c = cases[i];
      Row key{c.drive.half, c.configuration, number(c.length, 0)};
      if (by_drive) key.insert(key.begin(), c.drive.folder.filename().string());
      if (end.distance >= least_way) groups[key].push_back(end);
    }
  }
  Row heading{"half",
              "configuration",
              "length s",
              "outages",
              "mean m",
              "error m median",
              "worst",
              "% median",
              "worst",
              "error / sigma",
              "receiver's own m median"};
  if (by_drive) heading.insert(heading.begin(), "drive");
  Table table{"Made GNSS outages: error at their end against the fix of that time", heading, {}};
  for (const auto& [cells, ends] : groups) {
    std::vector<double> error, percent, normalized, peer;
    double way = 0.0;
    for (const fusion_score::OutageEnd& end : ends) {
      way += end.distance / static_cast<double>(ends.size());
      error.push_back(end.error);
      percent.push_back(end.percent());
      normalized.push_back(end.error / end.sigma);
      if (end.peer) peer.push_back(*end.peer);
    }
    Row& row = table.rows.emplace_back(cells);
    row.push_back(std::to_string(ends.size()));
    for (const double value : {way, median(error), largest(error), median(percent),
                               largest(percent), median(normalized), median(peer)})
      row.push_back(number(value, value < 100.0 ? 1 : 0));
  }
  return table;
}

struct OutageOptions {
  fs::path folder, config;
  std::vector<std::string> configurations{"GNSS+RI"};
  std::string half;
  bool by_drive = false, mounts_only = false;
};

int compare_outages(const OutageOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  std::vector<TableDrive> drives = drives_in(options.folder);
  if (!options.half.empty()) {
    std::erase_if(drives, [&](const TableDrive& drive) { return drive.half != options.half; });
  }
  std::cout << as_text(mount_table(drives)) << std::flush;
  if (options.mounts_only) return 0;
  std::vector<OutageCase> cases;
  for (const std::string& configuration : options.configurations)
    for (const double length : {10.0, 30.0, 60.0})
      for (const TableDrive& drive : drives) cases.push_back({drive, configuration, length});
  const auto results = run_all(
      cases,
      [](const OutageCase& c) {
        return c.drive.folder.filename().string() + ", " + c.configuration;
      },
      [&](const OutageCase& c) { return run(c, config); });
  if (std::all_of(results.begin(), results.end(), [](const auto& ends) { return ends.empty(); })) {
    throw std::runtime_error(
        "no outage can be scored: the drives are too short, or have no position before one");
  }
  std::cout << as_text(outage_table(cases, results, false));
  if (options.by_drive) std::cout << as_text(outage_table(cases, results, true));
  return 0;
}

}  // namespace

void add_outage_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<OutageOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "outages", "Drives of tables: the mount of the inertial unit, and made GNSS outages");
  sub->add_option("FOLDER", options->folder, "Folder of drives, each a folder with gnss.csv")
      ->required()
      ->check(existing_folder());
  sub->add_option("--configurations", options->configurations, "Of the filter")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--half", options->half, "odd: the drives to choose parameters on; even: others")
      ->check(CLI::IsMember({"odd", "even"}));
  sub->add_flag("--by-drive", options->by_drive, "A row for each drive, too");
  sub->add_flag("--mounts", options->mounts_only, "The mounts alone");
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  sub->callback([options, &command] { command = [options] { return compare_outages(*options); }; });
}

}  // namespace maploop::tools
