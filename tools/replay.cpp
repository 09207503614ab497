// maploop replay: a recorded drive through the whole graph.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "runtime/core/data_clock.h"
#include "runtime/core/periodic.h"
#include "runtime/core/realtime.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/channel_hashes.h"
#include "runtime/vehicle/fault_injection.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/lcm_bus.h"
#include "runtime/vehicle/limited_source.h"
#include "runtime/vehicle/log_recorder.h"
#include "runtime/vehicle/recording.h"
#include "runtime/vehicle/vehicle.h"
#include "runtime/vehicle/vehicle_config.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/commands.h"
#include "tools/evaluation/kitti_poses.h"
#include "tools/lcm_log/log_writer.h"
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
  bool record_raw = false;
  std::filesystem::path config;
  std::filesystem::path json;
  std::filesystem::path trace;
  std::filesystem::path poses;
  std::optional<std::int64_t> seed;
  std::vector<std::string> faults;
  std::string snapshot;  // SECONDS:FILE
  std::filesystem::path resume;
  PlaybackOptions playback;
  std::uint64_t loop = 1;  // 0: for ever
  double start = 0.0;      // s into the drive
  double end = 0.0;        // s; 0: the whole drive
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

struct SnapshotRequest {
  double seconds = 0.0;  // into the drive
  std::filesystem::path file;
};

SnapshotRequest parse_snapshot(const std::string& text) {
  const std::size_t colon = text.find(':');
  SnapshotRequest request{-1.0, colon == std::string::npos ? "" : text.substr(colon + 1)};
  const char* end = text.data() + std::min(colon, text.size());
  const auto [stopped, error] = std::from_chars(text.data(), end, request.seconds);
  if (error != std::errc{} || stopped != end || !(request.seconds > 0.0 && request.seconds < 1e6) ||
      request.file.empty()) {
    throw std::invalid_argument("'" + text +
                                "' is not SECONDS:FILE, seconds above 0, such as 8:drive.snapshot");
  }
  return request;
}

std::string valid_snapshot(const std::string& text) {
  try {
    parse_snapshot(text);
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

// What one pass through the recording comes to; made anew when it begins again.
struct Pass {
  Pass(const ReplayOptions& options, const vehicle::Recording& recording, Time cut)
      : hashes_after_snapshot(cut), collector(recording.calibration.stereo.T_body_cam) {
    if (!options.record.empty()) {
      recorder = std::make_unique<vehicle::LogRecorder>(options.record, options.record_raw);
    }
  }

  vehicle::ChannelHashes hashes;
  vehicle::ChannelHashes hashes_after_snapshot;
  std::unique_ptr<vehicle::LogRecorder> recorder;
  TrajectoryCollector collector;
};

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        config_(config_of(options)),
        readiness_(options.lockstep ? runtime::RealtimeReport{}
                                    : runtime::prepare_process(config_.memory)),
        recording_(vehicle::open_recording(options.drive, config_)),
        faults_(parse_faults(options.faults), recording_.first_stamp) {
    if (!options.record.empty()) lcm_log::refuse_same_file(options.drive, options.record);
    if (!options.no_lcm) {
      bus_ = std::make_unique<vehicle::LcmBus>(config_.lcm_url);
      runtime::append(readiness_, bus_->settings());
    }
    if (!options.resume.empty()) resumed_ = vehicle::read_snapshot(options.resume, config_);
    if (!options.snapshot.empty()) {
      snapshot_ = parse_snapshot(options.snapshot);
      cut_ = runtime::first_tick(recording_.first_stamp + from_seconds(snapshot_->seconds),
                                 vehicle::stages::fusion.period);
    }
  }

  int run();

 private:
  static vehicle::VehicleConfig config_of(const ReplayOptions& options) {
    vehicle::VehicleConfig config;
    if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
    if (options.seed) config.gnss.seed = *options.seed;
    return config;
  }

  static std::vector<vehicle::Fault> parse_faults(const std::vector<std::string>& texts) {
    std::vector<vehicle::Fault> faults;
    for (const std::string& text : texts) faults.push_back(vehicle::parse_fault(text));
    return faults;
  }

  std::unique_ptr<vehicle::Vehicle> make_vehicle(const vehicle::Snapshot* from);
  void resume(vehicle::Vehicle& vehicle) const;
  vehicle::PlayerParameters player_parameters() const;
  PlaybackEnd play_all();
  ReplayResult result(PlaybackEnd end);

  const ReplayOptions& options_;
  vehicle::VehicleConfig config_;
  runtime::RealtimeReport readiness_;
  vehicle::Recording recording_;
  vehicle::FaultInjection faults_;
  std::unique_ptr<vehicle::LcmBus> bus_;
  std::optional<vehicle::Snapshot> resumed_;
  std::optional<SnapshotRequest> snapshot_;
  Time cut_{};
  bool snapshot_taken_ = false;
  std::unique_ptr<Pass> pass_;
  std::unique_ptr<runtime::Tracer> tracer_;  // of the vehicle that runs
  std::unique_ptr<vehicle::Player> player_;
};

std::unique_ptr<vehicle::Vehicle> Replay::make_vehicle(const vehicle::Snapshot* from) {
  if (from == nullptr) {
    pass_.reset();  // its log is closed before the next one takes its name
    pass_ = std::make_unique<Pass>(options_, recording_, cut_);
  }
  const vehicle::Snapshot* start = from != nullptr ? from : resumed_ ? &*resumed_ : nullptr;
  // A fault may bring a sample from before the start later.
  const bool passes_over = start != nullptr && options_.faults.empty();
  vehicle::Sensors sensors = recording_.sensors(passes_over ? start->at : Time::min());
  if (options_.end > 0.0) {
    limit(sensors, recording_.first_stamp + from_seconds(options_.end));
  }
  std::vector<vehicle::MessageSink*> sinks{&pass_->hashes};
  if (snapshot_) sinks.push_back(&pass_->hashes_after_snapshot);
  if (bus_) sinks.push_back(bus_.get());
  if (pass_->recorder) sinks.push_back(pass_->recorder.get());

  vehicle::Observer observer;
  observer.odometry = [this](const RelativeMotion& motion) { pass_->collector.add(motion); };
  observer.image_state = [this](const NavState& state) { pass_->collector.add(state); };

  if (!options_.trace.empty()) {
    tracer_ = std::make_unique<runtime::Tracer>(config_.trace);
    tracer_->write(options_.trace);  // a file that cannot be written is said before the drive
  }

  const auto clock = options_.lockstep ? runtime::DataClock::virtual_time()
                                       : runtime::DataClock::paced(options_.speed);
  auto vehicle = std::make_unique<vehicle::Vehicle>(
      config_, recording_.calibration, faults_.afflict(std::move(sensors)), clock, std::move(sinks),
      std::move(observer), tracer_.get());
  vehicle->slow_down(faults_.delays());
  vehicle->prepared(readiness_);
  if (snapshot_) {
    vehicle->take_snapshots({cut_}, [this](const vehicle::Snapshot& snapshot) {
      vehicle::write_snapshot(snapshot_->file, snapshot, config_);
      snapshot_taken_ = true;
    });
  }
  if (from != nullptr) {
    vehicle->resume(*from);
  } else if (resumed_) {
    resume(*vehicle);
  }
  return vehicle;
}

void Replay::resume(vehicle::Vehicle& vehicle) const {
  try {
    vehicle.resume(*resumed_);
  } catch (const ArchiveError& e) {
    throw std::runtime_error("cannot resume from '" + options_.resume.string() + "': " + e.what());
  }
}

vehicle::PlayerParameters Replay::player_parameters() const {
  vehicle::PlayerParameters p;
  p.first = resumed_ ? resumed_->at : recording_.first_stamp;
  p.last = recording_.last_stamp;
  if (options_.end > 0.0) {
    p.last = std::min(p.last, recording_.first_stamp + from_seconds(options_.end));
  }
  p.start = recording_.first_stamp + from_seconds(options_.start);
  if (p.start > p.last) {
    throw std::runtime_error("--start " + shown(options_.start) + " lies after the end, at " +
                             shown(to_seconds(p.last - recording_.first_stamp)) + " s");
  }
  p.passes = options_.loop == 0 ? std::numeric_limits<std::uint64_t>::max() : options_.loop;
  return p;
}

PlaybackEnd Replay::play_all() {
  player_ = std::make_unique<vehicle::Player>(
      [this](const vehicle::Snapshot* from) { return make_vehicle(from); }, player_parameters());
  std::optional<vehicle::ReplayControl> control;
  if (bus_) control.emplace(bus_->lcm(), *player_);
  const auto hogs = faults_.hogs([this] { return player_->position(); });
  return play(*player_, control ? &*control : nullptr, options_.playback);
}

ReplayResult Replay::result(PlaybackEnd end) {
  ReplayResult result;
  result.drive = std::filesystem::weakly_canonical(options_.drive).filename().string();
  result.lockstep = options_.lockstep;
  result.speed = options_.speed;
  result.interrupted = end == PlaybackEnd::interrupted;
  result.images = recording_.images;
  result.vehicle = player_->vehicle().report();
  result.channels = pass_->hashes.summary();
  if (snapshot_taken_) {
    result.snapshot = {snapshot_->file.string(), to_seconds(cut_ - player_->vehicle().first()),
                       pass_->hashes_after_snapshot.summary()};
  }
  if (tracer_) {
    tracer_->write(options_.trace);
    result.trace = {options_.trace.string(), tracer_->recorded(), tracer_->dropped()};
  }
  result.faults = faults_.counts();
  if (const auto rows = recording_.sensors(Time::max()).reference) {
    const sensors::ReferenceTrajectory reference = read_reference(*rows);
    const auto pose = [&](Time t) { return reference.pose(t); };
    result.vo = pass_->collector.score_vo(pose);
    result.fused = pass_->collector.score_fused(pose);
  }
  return result;
}

int Replay::run() {
  const ReplayResult r = result(play_all());
  std::cout << format_table(r);
  if (!options_.json.empty()) write_json(options_.json, r);
  if (!options_.poses.empty()) {
    evaluation::write_kitti_poses(options_.poses, pass_->collector.fused());
  }
  const bool snapshot_missing = snapshot_ && !snapshot_taken_;
  if (snapshot_missing && !any_thread_failed(r)) {
    std::cerr << "maploop: no snapshot was written: the replay did not come to "
              << snapshot_->seconds << " s\n";
  }
  if (r.interrupted) return exit_interrupted;
  return snapshot_missing || any_thread_failed(r) ? exit_failed : 0;
}

}  // namespace

void add_replay(CLI::App& app, Command& command) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* sub = app.add_subcommand(
      "replay",
      "Replay a KITTI raw drive (synced and rectified) or a log of our own through the graph");
  sub->add_option("DRIVE", options->drive,
                  "Folder such as 2011_09_26/2011_09_26_drive_0013_sync, or a log (--record); one "
                  "without images is replayed from its odometry")
      ->required();
  auto* speed = sub->add_option("--speed", options->speed, "Times real time")
                    ->check(CLI::PositiveNumber)
                    ->capture_default_str();
  auto* lockstep =
      sub->add_flag("--lockstep", options->lockstep,
                    "On virtual time: no sleeping, no dropping, as fast as the graph goes")
          ->excludes(speed);
  sub->add_option("--start", options->start,
                  "Go through the first seconds as fast as the graph can")
      ->check(CLI::NonNegativeNumber)
      ->excludes(lockstep);
  sub->add_option("--end", options->end, "End this many seconds into the drive")
      ->check(CLI::PositiveNumber);
  sub->add_flag("--paused", options->playback.paused, "Wait for the space bar at the start")
      ->excludes(lockstep);
  sub->add_flag("--until-miss", options->playback.until_miss, "Pause at the first missed deadline")
      ->excludes(lockstep);
  sub->add_option("--loop", options->loop,
                  "Play so many times, 0: until it is stopped; results and --record are of the "
                  "last time")
      ->capture_default_str();
  sub->add_flag("--verbose", options->playback.verbose,
                "Say of every real-time setting what was granted, not only of those refused")
      ->excludes(lockstep);
  auto* record =
      sub->add_option("--record", options->record, "Write every message to this LCM log");
  sub->add_flag("--record-raw", options->record_raw,
                "With the images and scans, for a replay of the whole graph (30 MB/s)")
      ->needs(record);
  sub->add_flag("--no-lcm", options->no_lcm, "Publish nothing on LCM");
  sub->add_option("--config", options->config, "TOML file of parameters")->check(CLI::ExistingFile);
  sub->add_option("--snapshot", options->snapshot,
                  "SECONDS:FILE: save everything at this moment of the drive, and go on")
      ->check(valid_snapshot, "SECONDS:FILE");
  sub->add_option("--resume", options->resume,
                  "Go on from a snapshot of the same drive, with the same bits")
      ->check(CLI::ExistingFile);
  sub->add_option("--json", options->json, "Write the closing table to this file as JSON");
  sub->add_option("--trace", options->trace,
                  "Write what each thread did when to this file, for ui.perfetto.dev (after going "
                  "back: since then)");
  sub->add_option("--poses", options->poses,
                  "Write the fused left-camera poses to this file in KITTI's format");
  sub->add_option("--seed", options->seed, "Seed of the simulated GNSS noise");
  sub->add_option("--fault", options->faults,
                  "Inject KIND@TARGET[:START[:LENGTH]][,key=value...]; more than once for more "
                  "faults (README: Faults)")
      ->allow_extra_args(false)
      ->check(valid_fault, "FAULT");
  sub->callback([options, &command] { command = [options] { return Replay(*options).run(); }; });
}

}  // namespace maploop::tools
