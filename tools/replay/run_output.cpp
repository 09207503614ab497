#include "tools/replay/run_output.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/whole_file.h"
#include "runtime/core/data_clock.h"
#include "runtime/vehicle/output/black_box.h"
#include "tools/command/attempt.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/output_check.h"
#include "tools/command/terminal.h"
#include "tools/replay/nav_files.h"
#include "tools/replay/recorder.h"
#include "tools/report/report.h"

namespace maploop::tools {
namespace {

void write_states(const RunOptions& options, const RunPass& pass,
                  const Eigen::Isometry3d& T_body_cam) {
  const evaluation::StampedTrajectory fused =
      (options.frame == OutputFrame::odom ? pass.odom : pass.fused).poses(T_body_cam);
  for (const std::filesystem::path& file : {options.poses, options.tum}) {
    if (!file.empty() && fused.poses.empty()) {
      throw std::runtime_error(
          "'" + file.string() +
          "' is not written: no image has a fused pose; --csv and --nmea write "
          "the fused state without images");
    }
  }
  if (!options.poses.empty()) evaluation::write_kitti_poses(options.poses, fused.poses);
  if (!options.tum.empty()) evaluation::write_tum(options.tum, fused);
  if (!options.csv.empty()) write_nav_csv(options.csv, pass.track);
  if (!options.nmea.empty()) write_nmea(options.nmea, pass.track);
}

}  // namespace

void add_run_options(CLI::App* sub, RunOptions& options, WritePage* write_page) {
  add_settings(sub, options.settings);
  sub->add_flag("--verbose", options.verbose,
                "End with the tables of accuracy, sensors, losses, latencies and hashes, and say "
                "of every real-time setting what was granted");
  auto* record = add_output(sub, "--record", options.record,
                            "Write every message to this LCM log, or MCAP file (.mcap)");
  sub->add_flag("--record-raw", options.record_raw,
                "With the images and scans, for a replay of the whole graph (30 MB/s)")
      ->needs(record);
  auto* box = add_output(sub, "--black-box", options.black_box,
                         "Keep the newest of all messages, images and scans in this file of fixed "
                         "size, which survives whatever ends the run ('maploop log blackbox')");
  sub->add_option("--black-box-size", options.black_box_size, "Its size in MB")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->needs(box);
  auto* no_lcm = sub->add_flag("--no-lcm", options.no_lcm, "Publish nothing on LCM");
  add_lcm_url(sub, options.lcm_url)->excludes(no_lcm);
  add_output(sub, "--json", options.json, "Write all figures of the run to this file as JSON");
  options.write_page = write_page;
  if (write_page != nullptr) {
    add_output(sub, "--report", options.report,
               "Write a page with all of it to this file: way, errors, latencies, losses");
  }
  add_output(sub, "--trace", options.trace,
             "Write what each thread did when to this file, for ui.perfetto.dev (of a replay that "
             "went back: since then)");
  add_output(sub, "--state", options.state,
             "Start from what this file says of the car, if it exists, and keep there where the "
             "car is, and what is estimated of it: mounts, axle, antenna, scales, biases; with PPP "
             "its filter too, in FILE.ppp")
      ->check(output_place(OutputName::with_ppp));
  add_output(sub, "--poses", options.poses,
             "Write the fused left-camera poses to this file in KITTI's format");
  add_output(sub, "--tum", options.tum, "The same in TUM's format, with stamps");
  add_choice(sub, "--frame", options.frame,
             "Of --poses and --tum: map, which is absolute and may jump, or odom, which is "
             "continuous and drifts");
  add_output(sub, "--csv", options.csv,
             "Write the fused state every 100 ms to this file, with what its aids said");
  add_output(sub, "--nmea", options.nmea,
             "Write GGA, RMC, GST and HDT sentences of the fused state, once a second");
  sub->add_option(
         "--map", options.map,
         "OpenStreetMap file, or network file or tiled map of `maploop map build`: the fused "
         "state is matched to its roads")
      ->check(existing_file());
  add_choice(sub, "--map-mode", options.map_mode,
             "none; loose, the default where there is a map: matched, and nothing fed back; tight: "
             "the road goes back to the filter; hard-reset: position and azimuth become the "
             "matched ones");
}

std::vector<RealtimeSetting> RunOutput::open_bus() {
  if (options_.no_lcm) return {};
  const std::string url = vehicle::bus_url(options_.lcm_url, config_.lcm_url);
  bus_ = std::make_unique<vehicle::LcmBus>(url);
  presence_.emplace(bus_->lcm(), run_, [](const std::string& another) {
    std::cerr << "\nmaploop: " << another << '\n';
  });
  std::cerr << "Run " << run_.id << " at " << url << '\n';
  return bus_->settings();
}

std::vector<vehicle::MessageSink*> RunOutput::sinks(RunPass& pass,
                                                    vehicle::LogRecorder::WhenBehind behind) {
  std::vector<vehicle::MessageSink*> sinks{&pass.hashes};
  if (bus_) sinks.push_back(bus_.get());
  if (!options_.record.empty()) {
    if (!pass.recorder) pass.recorder = make_recorder(options_.record, options_.record_raw, behind);
    sinks.push_back(pass.recorder.get());
  }
  if (!options_.black_box.empty()) {
    if (!pass.black_box) {
      const std::uint64_t bytes = 1'000'000 * options_.black_box_size;
      pass.black_box = std::make_unique<vehicle::LogRecorder>(
          options_.black_box.string(), true, behind, vehicle::black_box_format(bytes));
    }
    sinks.push_back(pass.black_box.get());
  }
  return sinks;
}

void RunOutput::take_snapshots(vehicle::Vehicle& vehicle, RunPass& pass) {
  constexpr Duration every = std::chrono::seconds(10);
  car_.observe_ppp(vehicle, every);
  if (!pass.black_box) return;
  vehicle.take_snapshots(every, [this, &box = *pass.black_box](const vehicle::Snapshot& snapshot) {
    const Bytes bytes = vehicle::snapshot_bytes(snapshot, config_);
    box.send({channel_names::snapshot, snapshot.at, bytes, false});
  });
}

runtime::Tracer* RunOutput::new_tracer() {
  if (options_.trace.empty()) return nullptr;
  tracer_ = std::make_unique<runtime::Tracer>(config_.trace);
  const WholeFile writable(options_.trace);  // fails before the drive, not after it
  return tracer_.get();
}

ReplayResult RunOutput::result(const vehicle::Vehicle& vehicle, const RunPass& pass) const {
  ReplayResult result = result_of(pass, vehicle.report());
  result.run = run_.id;
  result.configuration = config_.configuration;
  result.begin = vehicle.first();
  if (tracer_) {
    result.trace = {options_.trace.string(), tracer_->recorded(), tracer_->dropped()};
  }
  return result;
}

bool RunOutput::write(const ReplayResult& result, const RunPass& pass,
                      const VehicleCalibration& calibration, std::vector<ReferencePose> reference,
                      const vehicle::RoadMap* map) {
  if (presence_) presence_->conclude(verdict_text(result));
  presence_.reset();
  bool all = !result.any_thread_failed();
  if (const std::uint64_t lost = pass.recorder == nullptr ? 0 : pass.recorder->health().unsent;
      lost > 0) {
    all = false;
    std::cerr << "maploop: '" << options_.record.string() << "' did not take " << lost
              << " messages; may it be written, and has the disk room?\n";
  }
  if (tracer_) all &= attempt([&] { tracer_->write(options_.trace); });
  if (!options_.json.empty()) all &= attempt([&] { write_json(options_.json, result); });
  if (result.end)
    all &= attempt([&] { write_states(options_, pass, calibration.stereo.T_body_cam); });
  all &= car_.write(result.vehicle);
  if (!options_.report.empty()) {
    all &= attempt([&] {
      const auto roads = map != nullptr ? roads_about(pass, *map) : nullptr;
      options_.write_page(options_.report,
                          {result, pass, std::move(reference), config_, roads.get()});
    });
  }
  // The verdict comes last, because its reader may be gone.
  std::cout << verdict_text(result)
            << (options_.verbose ? in_colour(STDOUT_FILENO, format_table(result)) : "");
  return all;
}

}  // namespace maploop::tools
