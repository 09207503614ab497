// maploop replay: a recorded drive through the whole graph.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "runtime/core/data_clock.h"
#include "runtime/core/realtime.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/channel_hashes.h"
#include "runtime/vehicle/fault_injection.h"
#include "runtime/vehicle/lcm_bus.h"
#include "runtime/vehicle/limited_source.h"
#include "runtime/vehicle/log_recorder.h"
#include "runtime/vehicle/vehicle.h"
#include "runtime/vehicle/vehicle_config.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/commands.h"
#include "tools/evaluation/kitti_poses.h"
#include "tools/replay_console.h"
#include "tools/replay_result.h"
#include "tools/trajectory_collector.h"

namespace maploop::tools {
namespace {

constexpr int exit_interrupted = 130;  // as shells report SIGINT
constexpr int exit_failed = 1;

struct ReplayOptions {
  std::filesystem::path drive;
  double speed = 1.0;
  bool lockstep = false;
  bool no_lcm = false;
  std::filesystem::path record;
  std::filesystem::path config;
  std::filesystem::path json;
  std::filesystem::path trace;
  std::filesystem::path poses;
  std::optional<std::int64_t> seed;
  std::vector<std::string> faults;
  PlaybackOptions playback;
  double end = 0.0;  // s; 0: the whole drive
};

// What is wrong with it, as CLI11's checks say it.
std::string valid_fault(const std::string& text) {
  try {
    vehicle::parse_fault(text);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

sensors::ReferenceTrajectory read_reference(sensors::Source<ReferencePose>& source) {
  std::vector<ReferencePose> rows;
  for (ReferencePose row; source.next(row);) rows.push_back(row);
  const LocalFrame frame(rows.empty() ? Geodetic{} : rows.front().position);
  return {rows, frame};
}

bool any_thread_failed(const ReplayResult& result) {
  const auto& threads = result.vehicle.health.threads;
  return std::any_of(threads.begin(), threads.end(),
                     [](const ThreadHealth& t) { return !t.failure.empty(); });
}

int replay(const ReplayOptions& options) {
  vehicle::VehicleConfig config;
  if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
  if (options.seed) config.gnss.seed = *options.seed;
  runtime::RealtimeReport readiness;
  if (!options.lockstep) readiness = runtime::prepare_process(config.memory);

  const sensors::KittiDrive drive(options.drive, config.replay);
  vehicle::Sensors sources;
  sources.camera = drive.camera();
  if (drive.has_velodyne()) sources.velodyne = drive.velodyne();
  if (drive.has_oxts()) {
    sources.imu = drive.imu();
    sources.gnss = drive.gnss(config.gnss);
    sources.reference = drive.reference();
  }

  if (options.end > 0.0) limit(sources, drive.first_stamp() + from_seconds(options.end));

  std::vector<vehicle::Fault> asked;
  for (const std::string& text : options.faults) asked.push_back(vehicle::parse_fault(text));
  vehicle::FaultInjection faults(std::move(asked), drive.first_stamp());
  sources = faults.afflict(std::move(sources));

  vehicle::ChannelHashes hashes;
  std::vector<vehicle::MessageSink*> sinks{&hashes};
  std::unique_ptr<vehicle::LcmBus> bus;
  if (!options.no_lcm) {
    bus = std::make_unique<vehicle::LcmBus>(config.lcm_url);
    sinks.push_back(bus.get());
    runtime::append(readiness, bus->settings());
  }
  std::unique_ptr<vehicle::LogRecorder> recorder;
  if (!options.record.empty()) {
    recorder = std::make_unique<vehicle::LogRecorder>(options.record);
    sinks.push_back(recorder.get());
  }

  TrajectoryCollector collector(drive.calibration().stereo.T_body_cam);
  vehicle::Observer observer;
  observer.odometry = [&](const RelativeMotion& motion) { collector.add(motion); };
  observer.image_state = [&](const NavState& state) { collector.add(state); };

  std::optional<runtime::Tracer> tracer;
  if (!options.trace.empty()) {
    tracer.emplace(config.trace);
    tracer->write(options.trace);  // a file that cannot be written is said before the drive
  }

  const auto clock = options.lockstep ? runtime::DataClock::virtual_time()
                                      : runtime::DataClock::paced(options.speed);
  vehicle::Vehicle vehicle(config, drive.calibration().stereo, std::move(sources), clock, sinks,
                           observer, tracer ? &*tracer : nullptr);
  vehicle.slow_down(faults.delays());
  vehicle.prepared(readiness);
  PlaybackEnd end = PlaybackEnd::finished;
  {
    const auto hogs = faults.hogs([&] { return vehicle.position(); });
    end = play(vehicle, drive.last_stamp(), options.playback);
  }

  ReplayResult result;
  result.drive = std::filesystem::weakly_canonical(options.drive).filename().string();
  result.lockstep = options.lockstep;
  result.speed = options.speed;
  result.interrupted = end == PlaybackEnd::interrupted;
  result.images = drive.frame_count();
  result.vehicle = vehicle.report();
  result.channels = hashes.summary();
  result.faults = faults.counts();
  if (tracer) {
    tracer->write(options.trace);
    result.trace = {options.trace.string(), tracer->recorded(), tracer->dropped()};
  }
  if (drive.has_oxts()) {
    const sensors::ReferenceTrajectory reference = read_reference(*drive.reference());
    const auto pose = [&](Time t) { return reference.pose(t); };
    result.vo = collector.score_vo(pose);
    result.fused = collector.score_fused(pose);
  }

  std::cout << format_table(result);
  if (!options.json.empty()) write_json(options.json, result);
  if (!options.poses.empty()) evaluation::write_kitti_poses(options.poses, collector.fused());
  if (result.interrupted) return exit_interrupted;
  return any_thread_failed(result) ? exit_failed : 0;
}

}  // namespace

void add_replay(CLI::App& app, Command& command) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* sub = app.add_subcommand(
      "replay", "Replay a KITTI raw drive (synced and rectified) through the whole graph");
  sub->add_option("DRIVE", options->drive, "Folder such as 2011_09_26/2011_09_26_drive_0013_sync")
      ->required();
  auto* speed = sub->add_option("--speed", options->speed, "Times real time")
                    ->check(CLI::PositiveNumber)
                    ->capture_default_str();
  auto* lockstep =
      sub->add_flag("--lockstep", options->lockstep,
                    "On virtual time: no sleeping, no dropping, as fast as the graph goes")
          ->excludes(speed);
  sub->add_option("--start", options->playback.start,
                  "Go through the first seconds as fast as the graph can")
      ->check(CLI::NonNegativeNumber)
      ->excludes(lockstep);
  sub->add_option("--end", options->end, "End this many seconds into the drive")
      ->check(CLI::PositiveNumber);
  sub->add_flag("--paused", options->playback.paused, "Wait for the space bar at the start")
      ->excludes(lockstep);
  sub->add_flag("--until-miss", options->playback.until_miss, "Pause at the first missed deadline")
      ->excludes(lockstep);
  sub->add_flag("--verbose", options->playback.verbose,
                "Say of every real-time setting what was granted, not only of those refused")
      ->excludes(lockstep);
  sub->add_option("--record", options->record, "Write every message to this LCM log");
  sub->add_flag("--no-lcm", options->no_lcm, "Publish nothing on LCM");
  sub->add_option("--config", options->config, "TOML file of parameters")->check(CLI::ExistingFile);
  sub->add_option("--json", options->json, "Write the closing table to this file as JSON");
  sub->add_option("--trace", options->trace,
                  "Write what each thread did when to this file, for ui.perfetto.dev");
  sub->add_option("--poses", options->poses,
                  "Write the fused left-camera poses to this file in KITTI's format");
  sub->add_option("--seed", options->seed, "Seed of the simulated GNSS noise");
  sub->add_option("--fault", options->faults,
                  "Inject KIND@TARGET[:START[:LENGTH]][,key=value...]; more than once for more "
                  "faults (README: Faults)")
      ->allow_extra_args(false)
      ->check(valid_fault, "FAULT");
  sub->callback([options, &command] { command = [options] { return replay(*options); }; });
}

}  // namespace maploop::tools
