#include "tools/replay/replay_run.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "mapmatch/map_area.h"
#include "msgs/frames.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/periodic.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/graph/graph.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/command/options.h"
#include "tools/command/terminal.h"
#include "tools/replay/run_output.h"
#include "tools/replay/wrong_road_map.h"

namespace maploop::tools {
namespace {

constexpr int exit_failed = 1;

std::string drive_name(const ReplayOptions& options) {
  return std::filesystem::weakly_canonical(options.drive).filename().string();
}

// Returns the configuration asked for, else the one that the other options need.
std::string configuration_of(const ReplayOptions& options, const vehicle::VehicleConfig& config) {
  if (!options.configuration.empty()) return options.configuration;
  const std::string name = options.speed_scale ? "RISS" : config.configuration;
  const bool adds_fixes =
      !options.gnss_outage.empty() && name != "auto" && !name.starts_with("GNSS");
  return adds_fixes ? "GNSS+" + name : name;
}

vehicle::VehicleConfig config_of(const ReplayOptions& options, vehicle::KnownContents& contents) {
  vehicle::VehicleConfig config =
      vehicle::load_vehicle_config(options.config, options.settings, options.topics);
  if (options.seed) config.gnss.seed = config.wheel.seed = config.imu_seed = *options.seed;
  contents = vehicle::fit_to_recording(config, options.drive);
  const std::string configuration = configuration_of(options, config);
  if (configuration != config.configuration) set_configuration(config, configuration);
  if (!options.gnss_outage.empty()) config.gnss_outage = options.gnss_outage;
  if (!options.odometry_poses.empty()) config.odometry_poses.file = options.odometry_poses;
  if (!options.imu.empty()) {
    config.imu_noise = options.imu;
    if (options.imu == "mems") set_imu_grade(config, "mems");
  }
  set_map(config.map, options.map, options.map_mode);
  if (options.speed_scale) config.wheel.scale_error = *options.speed_scale - 1.0;
  return config;
}

// Returns the roads that were driven, if the map is to have a fault.
match::Labels driven_roads(const ReplayOptions& options, const vehicle::Recording& recording) {
  return options.map_fault && recording.driven_links
             ? match::read_labels(recording.driven_links->file)
             : match::Labels{};
}

// Returns the way of the left camera that was asked for to score with.
std::optional<sensors::ReferenceTrajectory> camera_truth(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  const auto truth = evaluation::read_trajectory(file, evaluation::Role::truth);
  if (truth.stamps.size() < 2) {
    throw std::runtime_error("--truth " + file.string() +
                             ": fewer than two poses with stamps; give a TUM file");
  }
  return sensors::ReferenceTrajectory(truth.stamps, truth.poses);
}

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        config_(config_of(options, contents_)),
        readiness_(options.lockstep ? runtime::RealtimeReport{}
                                    : runtime::prepare_process(config_.memory)),
        recording_(vehicle::open_recording(options.drive, config_, contents_)),
        end_(options.end > 0.0 ? recording_.first_stamp + from_seconds(std::min(options.end, 1e9))
                               : Time::max()),
        map_(load_road_map(config_.map, options.map_fault, driven_roads(options, recording_))),
        faults_(options.faults, recording_.first_stamp, recording_.calibration.stereo.fx),
        output_(options, config_, "replay of " + drive_name(options)),
        camera_truth_(camera_truth(options.truth)) {
    describe_car(config_, recording_.calibration);              // for the report and the snapshots
    config_.vehicle.imu.time.delay = config_.replay.imu_delay;  // as the recording was read
    for (const std::string& note : recording_.notes) std::cerr << "maploop: " << note << '\n';
    look_ahead();
    runtime::append(readiness_, output_.open_bus());
    if (options.misdescribed) {
      misdescribe(config_, recording_,
                  misdescription(*options.misdescribed, options.seed.value_or(1)));
    }
    if (!options.resume.empty()) resumed_ = vehicle::read_snapshot(options.resume, config_);
    if (options.snapshot) {
      cut_ = runtime::first_tick(recording_.first_stamp + from_seconds(options.snapshot->seconds),
                                 vehicle::stages::fusion.period);
    }
  }

  int run();

 private:
  void look_ahead() const;
  std::unique_ptr<vehicle::Vehicle> make_vehicle(const vehicle::Snapshot* from);
  void place(vehicle::Vehicle& vehicle, const vehicle::Snapshot* from);
  vehicle::PlayerParameters player_parameters();
  PlaybackEnd play_all();
  ReplayResult result(PlaybackEnd end, const std::vector<ReferencePose>& reference);
  int status(const ReplayResult& result, bool written) const;

  const ReplayOptions& options_;
  vehicle::KnownContents contents_;
  vehicle::VehicleConfig config_;
  runtime::RealtimeReport readiness_;
  vehicle::Recording recording_;
  Time end_;  // the end asked for
  std::shared_ptr<const vehicle::RoadMap> map_;
  vehicle::FaultInjection faults_;
  RunOutput output_;
  std::optional<sensors::ReferenceTrajectory> camera_truth_;
  std::optional<vehicle::Snapshot> resumed_;
  Time cut_{};  // of the snapshot
  bool snapshot_taken_ = false;
  std::unique_ptr<RunPass> pass_;  // made again when the recording begins again
  std::unique_ptr<vehicle::Player> player_;
};

// Reports before the drive what would spoil its result.
void Replay::look_ahead() const {
  const vehicle::Sensors sensors = recording_.sensors(Time::max());
  if (options_.speed_scale && sensors.wheel == nullptr) {
    throw std::runtime_error("--speed-scale: the recording '" + options_.drive.string() +
                             "' has no wheel speeds to scale");
  }
  if (options_.speed_scale && !recording_.wheels_are_made) {
    throw std::runtime_error(
        "--speed-scale: the recording '" + options_.drive.string() +
        "' has wheel speeds of its own, which are used as they are; only those "
        "that are made from a recorder's speed can be scaled");
  }
  for (const std::filesystem::path& file : {options_.poses, options_.tum}) {
    if (!file.empty() && sensors.camera == nullptr && sensors.odometry == nullptr) {
      throw std::runtime_error("'" + file.string() +
                               "' would be empty: the recording has no images, and so no poses of "
                               "a camera; --csv and --nmea write the fused state without images");
    }
  }
  GnssFix fix;
  if (map_ == nullptr || sensors.gnss == nullptr || !sensors.gnss->next(fix)) return;
  const mapmatch::GeographicBox area = vehicle::area_of(*map_);
  if (mapmatch::covers(area, fix.position, far_from_map)) return;
  std::cerr << "maploop: the drive begins at " << degrees(fix.position.latitude) << ", "
            << degrees(fix.position.longitude) << ", far outside of the map, which covers "
            << mapmatch::to_text(area) << "; is it the map of this place?\n";
}

std::unique_ptr<vehicle::Vehicle> Replay::make_vehicle(const vehicle::Snapshot* from) {
  if (from == nullptr) {
    pass_.reset();  // its log must be closed before the next one takes its name
    pass_ = std::make_unique<RunPass>(cut_);
  }
  const vehicle::Snapshot* start = from != nullptr ? from : resumed_ ? &*resumed_ : nullptr;
  // A fault may delay a sample from before the start.
  const bool passes_over = start != nullptr && options_.faults.empty();
  vehicle::Sensors sensors = recording_.sensors(passes_over ? start->at : Time::min());
  if (end_ != Time::max()) limit(sensors, end_);
  std::vector<vehicle::MessageSink*> sinks =
      output_.sinks(*pass_, vehicle::LogRecorder::WhenBehind::wait);
  if (options_.snapshot) sinks.push_back(&pass_->hashes_after);
  const auto clock = options_.lockstep ? runtime::DataClock::virtual_time()
                                       : runtime::DataClock::paced(options_.speed);
  vehicle::Observer observer = pass_->observer();
  output_.car().observe(observer);
  auto vehicle = std::make_unique<vehicle::Vehicle>(
      config_, recording_.calibration, faults_.inject(std::move(sensors)), clock, std::move(sinks),
      std::move(observer), output_.new_tracer(), map_);
  vehicle->slow_down(faults_.delays());
  vehicle->prepared(readiness_);
  if (options_.snapshot) {
    vehicle->take_snapshots({cut_}, [this](const vehicle::Snapshot& snapshot) {
      vehicle::write_snapshot(options_.snapshot->file, snapshot, config_);
      snapshot_taken_ = true;
    });
  }
  output_.take_snapshots(*vehicle, *pass_);
  place(*vehicle, from);
  return vehicle;
}

// Puts a new vehicle where it goes on, or where it starts.
void Replay::place(vehicle::Vehicle& vehicle, const vehicle::Snapshot* from) {
  output_.car().recall(vehicle);
  if (from != nullptr) {
    vehicle.resume(*from);
  } else if (resumed_) {
    try {
      vehicle.resume(*resumed_);
    } catch (const ArchiveError& e) {
      throw std::runtime_error("cannot resume from '" + options_.resume.string() +
                               "': " + e.what());
    }
  } else if (options_.start_from_reference) {
    vehicle.start_from(vehicle::start_from_reference(recording_));
  }
}

vehicle::PlayerParameters Replay::player_parameters() {
  vehicle::PlayerParameters p;
  p.first = resumed_ ? resumed_->at : recording_.first_stamp;
  p.last = std::min(recording_.last_stamp, end_);
  p.start = recording_.first_stamp + from_seconds(options_.start);
  const auto moment = [&](Time t) { return shown(to_seconds(t - recording_.first_stamp)) + " s"; };
  if (resumed_ && end_ < resumed_->at) {
    throw std::runtime_error("--end " + moment(end_) +
                             " lies before the snapshot of --resume, at " + moment(resumed_->at));
  }
  if (options_.snapshot && (cut_ > end_ || (resumed_ && cut_ <= resumed_->at))) {
    throw std::runtime_error("--snapshot " + shown(options_.snapshot->seconds) +
                             " s lies outside of what is played, " + moment(p.first) + " to " +
                             moment(p.last));
  }
  if (p.last < p.first) {
    throw std::runtime_error("'" + options_.drive.string() + "' ends " +
                             shown(to_seconds(p.first - p.last)) +
                             " s before it begins: do the stamps of its images run backwards?");
  }
  if (p.start > p.last) {
    throw std::runtime_error("--start " + shown(options_.start) + " lies after the end, at " +
                             moment(p.last));
  }
  // Without a bus and a terminal, nobody can send the replay back, so it keeps no snapshots.
  if (output_.bus() == nullptr && isatty(STDIN_FILENO) == 0) p.snapshots = 0;
  p.passes = options_.loop == 0 ? std::numeric_limits<std::uint64_t>::max() : options_.loop;
  return p;
}

PlaybackEnd Replay::play_all() {
  player_ = std::make_unique<vehicle::Player>(
      [this](const vehicle::Snapshot* from) { return make_vehicle(from); }, player_parameters());
  std::optional<vehicle::ReplayControl> control;
  // Nobody can pause or go back on virtual time.
  if (output_.bus() != nullptr && !options_.lockstep)
    control.emplace(output_.bus()->lcm(), *player_, output_.run());
  const auto hogs = faults_.hogs([this] { return player_->position(); });
  return play(*player_, control ? &*control : nullptr, output_.presence(), options_.playback,
              options_.verbose);
}

ReplayResult Replay::result(PlaybackEnd end, const std::vector<ReferencePose>& reference) {
  ReplayResult result = output_.result(player_->vehicle(), *pass_);
  result.drive = drive_name(options_);
  result.lockstep = options_.lockstep;
  result.speed = options_.speed;
  result.interrupted = end == PlaybackEnd::interrupted;
  result.faults = faults_.counts();
  if (snapshot_taken_) {
    result.snapshot = {options_.snapshot->file.string(),
                       to_seconds(cut_ - player_->vehicle().first()),
                       pass_->hashes_after.summary()};
  }
  score(result, *pass_, recording_, reference, map_.get(),
        camera_truth_ ? &*camera_truth_ : nullptr, from_seconds(options_.score_from));
  return result;
}

int Replay::status(const ReplayResult& r, bool written) const {
  const auto why = why_empty(r);
  if (why) std::cerr << "maploop: " << *why << '\n';
  const bool snapshot_missing = options_.snapshot && !snapshot_taken_;
  if (snapshot_missing && !r.any_thread_failed()) {
    std::cerr << "maploop: no snapshot was written: the replay did not come to "
              << options_.snapshot->seconds << " s\n";
  }
  if (r.interrupted) return interrupted_status();
  return why || snapshot_missing || !written ? exit_failed : 0;
}

int Replay::run() {
  const PlaybackEnd end = play_all();
  const auto reference = sensors::read_rows(recording_.sensors(Time::max()).reference);
  const ReplayResult r = result(end, reference);
  return status(r, output_.write(r, *pass_, recording_.calibration, reference, map_.get()));
}

}  // namespace

int replay(const ReplayOptions& options) {
  return Replay(options).run();
}

}  // namespace maploop::tools
