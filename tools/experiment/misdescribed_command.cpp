// maploop experiment misdescribed: what a description of the car costs that is wrong by half a
// metre, a degree and 30 ms, once the filter has had time to find out.
#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "runtime/vehicle/config/vehicle_config.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/kitti_metric.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/misdescription.h"
#include "tools/experiment/sequence_run.h"
#include "tools/experiment/table.h"
#include "tools/replay/run_pass.h"

namespace maploop::tools {
namespace {

using namespace experiments;
namespace fs = std::filesystem;

struct MisdescribedOptions {
  std::vector<fs::path> drives;
  std::string configuration = "GNSS+RISS";
  std::vector<std::int64_t> seeds{1, 2};
  double after = 60.0;  // s
  double outage = 0.0;  // s
  fs::path config;
  bool calibration = false;
};

struct MisdescribedCase {
  fs::path drive;
  Property property = Property::nothing;
  std::int64_t seed = 1;
};

struct MisdescribedResult {
  double position = 0.0;  // m, horizontal root mean square of the map output
  double relative = 0.0;  // %, of 100 m, of the odom output
  fusion::SelfCalibrations calibration{};
};

// One outage after another, with a minute between them, from `after` on.
std::string outages_after(double after, double length, double duration) {
  constexpr double between = 60.0;
  std::string text;
  for (double start = after; length > 0.0 && start + length < duration; start += length + between)
    text += (text.empty() ? "" : ",") + number(start, 1) + ":" + number(length, 1);
  return text;
}

// Returns the mean error over 100 m, after one rotation of the body for each stretch without a gap
// of the reference: which axes the body has is only what the description says.
double relative_error(const TrajectoryCollector& odom, const std::vector<ReferencePose>& reference,
                      const LocalFrame& frame) {
  constexpr double segment = 100.0;  // m
  constexpr auto gap = std::chrono::milliseconds(500);
  const sensors::ReferenceTrajectory truth(reference, frame);
  double sum = 0.0;
  int segments = 0;
  evaluation::Trajectory estimated, true_poses;
  const auto score_stretch = [&] {
    if (estimated.size() > 1) {
      const auto error =
          evaluation::score(estimated, true_poses, segment, evaluation::CommonRotation::remove)
              .segment;
      if (error.segments > 0) sum += error.percent * error.segments;
      segments += error.segments;
    }
    estimated.clear();
    true_poses.clear();
  };
  const evaluation::StampedTrajectory all = odom.poses();
  Time last{};
  for (std::size_t i = 0; i < all.stamps.size(); ++i) {
    const Time stamp = all.stamps[i];
    const auto pose = truth.pose(stamp);
    if (!pose || truth.accuracy(stamp) > fusion_score::worst_reference) continue;
    if (stamp - last > gap) score_stretch();
    last = stamp;
    estimated.push_back(all.poses[i]);
    true_poses.push_back(*pose);
  }
  score_stretch();
  return segments > 0 ? sum / segments : NAN;
}

double root_mean_square(const fusion_score::Score& score) {
  double sum = 0.0, time = 0.0;
  for (const fusion_score::OutageErrors& o : score.outages) {
    sum += o.length * o.errors.rmse * o.errors.rmse;
    time += o.length;
  }
  return time > 0.0 ? std::sqrt(sum / time) : NAN;
}

MisdescribedResult run(const MisdescribedCase& c, const MisdescribedOptions& options,
                       vehicle::VehicleConfig config) {
  set_configuration(config, options.configuration);
  config.gnss.seed = config.wheel.seed = config.imu_seed = c.seed;
  vehicle::Recording recording = vehicle::open_recording(c.drive, config);
  const double duration = to_seconds(recording.last_stamp - recording.first_stamp);
  config.gnss_outage = outages_after(options.after, options.outage, duration);
  if (!config.gnss_outage.empty()) recording = vehicle::open_recording(c.drive, config);
  const Time settled = recording.first_stamp + from_seconds(options.after);

  vehicle::VehicleConfig known = config;
  describe_car(known, recording.calibration);
  config.vehicle = known.vehicle;
  const Misdescription wrong = misdescription(c.property, c.seed);
  misdescribe(config, wrong);
  recording.sensors = [plain = std::move(recording.sensors), wrong,
                       calibration = recording.calibration, drive = c.drive](Time passed) {
    vehicle::Sensors s = plain(passed);
    if (s.camera != nullptr || s.velodyne != nullptr) {
      throw std::runtime_error("'" + drive.string() +
                               "' has images or scans: name the log of its "
                               "odometry, from 'maploop replay DRIVE --record FILE'");
    }
    misdescribe(s, wrong, calibration);
    return s;
  };
  TrajectoryCollector odom;
  vehicle::Observer observer;
  observer.nav_state = [&](const FusedState& s) {
    constexpr std::uint64_t every = 10;
    if (s.status == NavStatus::uninitialized || s.sequence % every != 0 || s.stamp < settled)
      return;
    odom.add(s.stamp, s.odom.position, s.odom.attitude);
  };
  const RecordingRun run = run_recording(std::move(recording), config, {}, std::move(observer));
  std::vector<vehicle::GnssOutage> scored = run.recording.outages;
  if (scored.empty()) scored.push_back({settled, run.recording.last_stamp});
  const auto score =
      fusion_score::score(run.track, run.reference, scored, run.recording.first_stamp);
  if (!score || score->outages.empty()) {
    throw std::runtime_error("'" + c.drive.string() + "' has nothing to score after " +
                             number(options.after, 0) + " s");
  }
  const LocalFrame frame(run.track.states().front().origin);
  return {root_mean_square(*score), relative_error(odom, run.reference, frame),
          run.report.calibration};
}

// Pairs of the same drive and seed.
struct Pair {
  MisdescribedCase wrong_case;
  MisdescribedResult right, wrong;
};

double pooled(const std::vector<Pair>& pairs, MisdescribedResult Pair::*which,
              double MisdescribedResult::*value, bool squares) {
  double sum = 0.0, count = 0.0;
  for (const Pair& p : pairs) {
    const double v = p.*which.*value;
    if (!std::isfinite(v)) continue;
    sum += squares ? v * v : v;
    count += 1.0;
  }
  return squares ? std::sqrt(sum / count) : sum / count;
}

Table loss_table(const std::vector<Pair>& pairs) {
  Groups<std::vector<Pair>> groups;
  for (const Pair& p : pairs) {
    const std::string property(to_string(p.wrong_case.property));
    groups[{property, p.wrong_case.drive.stem().stem().string()}].push_back(p);
    groups[{property, "pooled"}].push_back(p);
  }
  Table table{"Loss by a wrong description, against the right one",
              {"wrong", "drive", "runs", "map m, right", "wrong", "loss %", "odom %, right",
               "wrong", "loss %"},
              {}};
  for (const auto& [cells, group] : groups) {
    Row& row = table.rows.emplace_back(cells);
    row.push_back(std::to_string(group.size()));
    using R = MisdescribedResult;
    for (const auto& [value, squares] : {std::pair(&R::position, true), {&R::relative, false}}) {
      const double right = pooled(group, &Pair::right, value, squares);
      const double wrong = pooled(group, &Pair::wrong, value, squares);
      row.push_back(number(right, 3));
      row.push_back(number(wrong, 3));
      row.push_back(number(100.0 * (wrong / right - 1.0), 1));
    }
  }
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [](const Row& a, const Row& b) { return a[0] < b[0]; });
  return table;
}

// Lists the properties of the car that the filter has estimated differently with the wrong
// description, with their last values.
Table calibration_table(const std::vector<Pair>& pairs) {
  constexpr double otherwise = 1.0;  // sigmas
  Table table{"What the filter has estimated, where it differs by more than its sigma",
              {"wrong", "drive", "seed", "property", "unit", "right", "sigma", "wrong", "sigma",
               "observed"},
              {}};
  for (const Pair& p : pairs) {
    for (std::size_t i = 0; i < p.right.calibration.size(); ++i) {
      const fusion::CalibratedProperty& right = p.right.calibration[i];
      const fusion::CalibratedProperty& wrong = p.wrong.calibration[i];
      if (std::abs(wrong.value - right.value) <= otherwise * std::max(right.sigma, wrong.sigma))
        continue;
      table.rows.push_back(
          {std::string(to_string(p.wrong_case.property)), p.wrong_case.drive.stem().stem().string(),
           std::to_string(p.wrong_case.seed), std::string(right.name), std::string(right.unit),
           number(right.value, 3), number(right.sigma, 3), number(wrong.value, 3),
           number(wrong.sigma, 3), wrong.observed() ? "yes" : "not yet"});
    }
  }
  return table;
}

bool is_of_camera(Property property) {
  return property == Property::camera || property == Property::camera_stamps;
}

// The right description of a drive comes before the wrong ones.
std::vector<MisdescribedCase> cases_of(const MisdescribedOptions& options,
                                       const vehicle::VehicleConfig& config) {
  std::vector<MisdescribedCase> cases;
  for (const fs::path& drive : options.drives) {
    const vehicle::Recording recording = vehicle::open_recording(drive, config);
    const bool odometry = recording.sensors(Time::max()).odometry != nullptr;
    for (const std::int64_t seed : options.seeds) {
      for (std::size_t i = 0; i < count_of<Property>; ++i) {
        const auto property = static_cast<Property>(i);
        if (odometry || !is_of_camera(property)) cases.push_back({drive, property, seed});
      }
    }
  }
  return cases;
}

int compare_descriptions(const MisdescribedOptions& options) {
  const vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  const auto cases = cases_of(options, config);
  const auto results = run_all(
      cases,
      [](const MisdescribedCase& c) {
        return c.drive.filename().string() + ", " + std::string(to_string(c.property));
      },
      [&](const MisdescribedCase& c) { return run(c, options, config); });
  std::vector<Pair> pairs;
  std::size_t right = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].property == Property::nothing) {
      right = i;
    } else {
      pairs.push_back({cases[i], results[right], results[i]});
    }
  }
  std::cout << as_text(loss_table(pairs));
  if (options.calibration) std::cout << as_text(calibration_table(pairs));
  return 0;
}

}  // namespace

void add_misdescribed_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MisdescribedOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "misdescribed", "A car described 0.5 m, 1 degree, 30 ms wrong: loss by each property");
  sub->add_option("DRIVE", options->drives,
                  "Drives without images: sequences as FOLDER/NAME, logs of an odometry")
      ->required();
  sub->add_option("--configuration", options->configuration, "Of the filter")
      ->capture_default_str();
  sub->add_option("--seeds", options->seeds, "Of what is wrong, and of the simulated noise")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--after", options->after, "Seconds before the drive is scored")
      ->check(number_from_zero())
      ->capture_default_str();
  sub->add_option("--outage", options->outage,
                  "Seconds of GNSS outages, one a minute, in which the position is scored")
      ->check(number_from_zero())
      ->capture_default_str();
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  sub->add_flag("--calibration", options->calibration, "What the filter has estimated, too");
  sub->callback(
      [options, &command] { command = [options] { return compare_descriptions(*options); }; });
}

}  // namespace maploop::tools
