#include "tools/replay/replay_run.h"

#include <algorithm>
#include <charconv>
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
#include "runtime/core/trace.h"
#include "runtime/core/whole_file.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/graph/graph.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/command/map_options.h"
#include "tools/command/terminal.h"
#include "tools/log/log_writer.h"
#include "tools/match/driven_links.h"
#include "tools/replay/fusion_score.h"
#include "tools/replay/replay_result.h"
#include "tools/replay/run_pass.h"
#include "tools/replay/verdict.h"

namespace maploop::tools {
namespace {

constexpr int exit_failed = 1;
constexpr double far_from_map = 5'000.0;  // m

// Of one pass through the recording; made anew when it begins again.
struct Pass : RunPass {
  Pass(const ReplayOptions& options, const vehicle::Recording& recording, Time cut)
      : RunPass(recording.calibration), hashes_after_snapshot(cut) {
    if (!options.record.empty()) {
      recorder = std::make_unique<vehicle::LogRecorder>(options.record, options.record_raw);
    }
  }

  vehicle::ChannelHashes hashes_after_snapshot;
};

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        config_(config_of(options)),
        readiness_(options.lockstep ? runtime::RealtimeReport{}
                                    : runtime::prepare_process(config_.memory)),
        recording_(vehicle::open_recording(options.drive, config_)),
        map_(vehicle::load_road_map(config_.map)),
        faults_(parse_faults(options.faults), recording_.first_stamp),
        run_(vehicle::new_run("replay of " + drive_name(options))) {
    describe_car(config_, recording_.calibration);  // for the report and the snapshots
    if (!options.record.empty()) lcm_log::refuse_same_file(options.drive, options.record);
    look_ahead();
    if (!options.no_lcm) {
      const std::string url = vehicle::bus_url(options.lcm_url, config_.lcm_url);
      bus_ = std::make_unique<vehicle::LcmBus>(url);
      std::cerr << "Run " << run_.id << " at " << url << '\n';
      runtime::append(readiness_, bus_->settings());
    }
    if (!options.resume.empty()) resumed_ = vehicle::read_snapshot(options.resume, config_);
    if (options.snapshot) {
      cut_ = runtime::first_tick(recording_.first_stamp + from_seconds(options.snapshot->seconds),
                                 vehicle::stages::fusion.period);
    }
  }

  int run();

 private:
  static vehicle::VehicleConfig config_of(const ReplayOptions& options) {
    vehicle::VehicleConfig config;
    if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
    if (options.seed) {
      config.gnss.seed = config.wheel.seed = config.imu_seed = *options.seed;
    }
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

  // The one asked for; else what the other options make sense with.
  static std::string configuration_of(const ReplayOptions& options,
                                      const vehicle::VehicleConfig& config) {
    if (!options.configuration.empty()) return options.configuration;
    const std::string name = options.speed_scale ? "RISS" : config.configuration;
    const bool adds_fixes = !options.gnss_outage.empty() && !name.starts_with("GNSS+");
    return adds_fixes ? "GNSS+" + name : name;
  }

  static std::string drive_name(const ReplayOptions& options) {
    return std::filesystem::weakly_canonical(options.drive).filename().string();
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
  void look_ahead() const;

  const ReplayOptions& options_;
  vehicle::VehicleConfig config_;
  runtime::RealtimeReport readiness_;
  vehicle::Recording recording_;
  std::shared_ptr<const vehicle::RoadMap> map_;
  vehicle::FaultInjection faults_;
  vehicle::Run run_;
  std::unique_ptr<vehicle::LcmBus> bus_;
  std::optional<vehicle::RunPresence> presence_;  // on it
  std::optional<vehicle::Snapshot> resumed_;
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
  if (options_.snapshot) sinks.push_back(&pass_->hashes_after_snapshot);
  if (bus_) sinks.push_back(bus_.get());
  if (pass_->recorder) sinks.push_back(pass_->recorder.get());

  if (!options_.trace.empty()) {
    tracer_ = std::make_unique<runtime::Tracer>(config_.trace);
    runtime::WholeFile(options_.trace);  // one that cannot be written is said before the drive
  }

  const auto clock = options_.lockstep ? runtime::DataClock::virtual_time()
                                       : runtime::DataClock::paced(options_.speed);
  auto vehicle = std::make_unique<vehicle::Vehicle>(
      config_, recording_.calibration, faults_.inject(std::move(sensors)), clock, std::move(sinks),
      pass_->observer(), tracer_.get(), map_);
  vehicle->slow_down(faults_.delays());
  vehicle->prepared(readiness_);
  if (options_.start_from_reference && from == nullptr && !resumed_) {
    vehicle->start_from(vehicle::start_from_reference(recording_));
  }
  if (options_.snapshot) {
    vehicle->take_snapshots({cut_}, [this](const vehicle::Snapshot& snapshot) {
      vehicle::write_snapshot(options_.snapshot->file, snapshot, config_);
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

// What can be known of the result before the drive.
void Replay::look_ahead() const {
  const vehicle::Sensors sensors = recording_.sensors(Time::max());
  for (const std::filesystem::path& file : {options_.states.poses, options_.states.tum}) {
    if (!file.empty() && sensors.camera == nullptr && sensors.odometry == nullptr)
      throw std::runtime_error("'" + file.string() +
                               "' would be empty: the recording has no images, and so no poses of "
                               "a camera; --csv and --nmea write the fused state without images");
  }
  GnssFix fix;
  std::optional<Geodetic> begin;
  if (sensors.gnss != nullptr && sensors.gnss->next(fix)) begin = fix.position;
  if (map_ == nullptr || !begin) return;
  const mapmatch::GeographicBox area = mapmatch::area_of(map_->network);
  if (mapmatch::covers(area, *begin, far_from_map)) return;
  std::cerr << "maploop: the drive begins at " << degrees(begin->latitude) << ", "
            << degrees(begin->longitude) << ", far outside of the map, which covers "
            << mapmatch::to_text(area) << "; is it the map of this place?\n";
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
  if (p.last < p.first) {
    throw std::runtime_error("'" + options_.drive.string() + "' ends " +
                             shown(to_seconds(p.first - p.last)) +
                             " s before it begins: do the stamps of its images run backwards?");
  }
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
  if (bus_) presence_.emplace(bus_->lcm(), run_, warn_of_another_run);
  // On virtual time nobody pauses or goes back.
  if (bus_ && !options_.lockstep) control.emplace(bus_->lcm(), *player_, run_.id);
  const auto hogs = faults_.hogs([this] { return player_->position(); });
  return play(*player_, control ? &*control : nullptr, presence_ ? &*presence_ : nullptr,
              options_.playback, options_.verbose);
}

ReplayResult Replay::result(PlaybackEnd end) {
  ReplayResult result;
  result.run = run_.id;
  result.drive = drive_name(options_);
  result.lockstep = options_.lockstep;
  result.speed = options_.speed;
  result.interrupted = end == PlaybackEnd::interrupted;
  result.images = recording_.images;
  result.vehicle = player_->vehicle().report();
  result.channels = pass_->hashes.summary();
  if (snapshot_taken_) {
    result.snapshot = {options_.snapshot->file.string(),
                       to_seconds(cut_ - player_->vehicle().first()),
                       pass_->hashes_after_snapshot.summary()};
  }
  if (tracer_) {
    result.trace = {options_.trace.string(), tracer_->recorded(), tracer_->dropped()};
  }
  result.ppp = pass_->ppp;
  result.configuration = config_.configuration;
  result.end = pass_->end;
  const vehicle::Sensors sensors = recording_.sensors(Time::max());
  result.has_gnss = sensors.gnss != nullptr || sensors.epochs != nullptr;
  if (result.ppp && sensors.ppp) result.ppp->never_converges = sensors.ppp->never_converges();
  if (map_ && result.end) {
    const mapmatch::GeographicBox area = mapmatch::area_of(map_->network);
    const auto& moments = pass_->road_moments;
    const bool on_road = std::any_of(moments.begin(), moments.end(),
                                     [](const auto& moment) { return moment.second.on_road; });
    const Geodetic last = LocalFrame(result.end->origin).to_geodetic(result.end->position_enu);
    result.map = {mapmatch::to_text(area), !on_road && !mapmatch::covers(area, last, far_from_map)};
  }
  result.faults = faults_.counts();
  if (map_ && recording_.driven_links) {
    std::vector<match::TimedMatch> matches;
    for (const auto& [stamp, match] : pass_->matches) matches.push_back(match);
    auto labels = match::read_labels(recording_.driven_links->file);
    match::SegmentLinks(map_->network).look_up(labels);
    result.links = match::score_matches(matches, recording_.driven_links->stamps, labels);
  }
  if (const auto rows = sensors::read_rows(recording_.sensors(Time::max()).reference);
      rows.size() > 1) {
    const sensors::ReferenceTrajectory reference(rows, LocalFrame(rows.front().position));
    const auto pose = [&](Time t) { return reference.pose(t); };
    result.vo = pass_->collector.score_vo(pose);
    result.lidar = pass_->lidar_collector.score_vo(pose);
    result.fused = pass_->collector.score_fused(pose);
    result.navigation =
        fusion_score::score(pass_->track, rows, recording_.outages, recording_.first_stamp);
  }
  return result;
}

int Replay::run() {
  const ReplayResult r = result(play_all());
  if (presence_) presence_->conclude(verdict_text(r));
  presence_.reset();
  // The table last: whoever reads it may have gone.
  const bool written = write_all({
      [&] {
        if (tracer_) tracer_->write(options_.trace);
      },
      [&] {
        if (!options_.json.empty()) write_json(options_.json, r);
      },
      [&] {
        if (r.end) write_states(options_.states, *pass_);
      },
      [&] {
        if (options_.report.empty()) return;
        write_run_report(options_.report, r, *pass_,
                         sensors::read_rows(recording_.sensors(Time::max()).reference), config_,
                         map_.get());
      },
  });
  std::cout << closing_text(r, options_.verbose);
  const auto why = why_empty(r);
  if (why) std::cerr << "maploop: " << *why << '\n';
  const bool snapshot_missing = options_.snapshot && !snapshot_taken_;
  if (snapshot_missing && !any_thread_failed(r)) {
    std::cerr << "maploop: no snapshot was written: the replay did not come to "
              << options_.snapshot->seconds << " s\n";
  }
  if (r.interrupted) return interrupted_status();
  const bool failed =
      why || snapshot_missing || any_thread_failed(r) || !pass_->recorded_all() || !written;
  return failed ? exit_failed : 0;
}

}  // namespace

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

int replay(const ReplayOptions& options) {
  return Replay(options).run();
}

}  // namespace maploop::tools
