// What one run of the vehicle comes to, gathered while it runs.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "runtime/vehicle/output/log_recorder.h"
#include "runtime/vehicle/output/publisher.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tools/match/driven_links.h"
#include "tools/replay/fusion_score.h"
#include "tools/replay/replay_result.h"
#include "tools/replay/trajectory_collector.h"
#include "tools/report/report.h"

namespace maploop::tools {

// Says a sentence of vehicle::RunPresence on standard error, on a line of its own.
void warn_of_another_run(const std::string& sentence);

// Filled on the publisher's thread; to be read after the run.
struct RunPass {
  explicit RunPass(const VehicleCalibration& calibration)
      : collector(calibration.stereo.T_body_cam), lidar_collector(calibration.stereo.T_body_cam) {}

  // Must not outlive the pass.
  vehicle::Observer observer();
  // Of the last state alone, whatever the length of the run.
  vehicle::Observer end_observer();

  vehicle::ChannelHashes hashes;
  // Whether the log asked for holds every message.
  bool recorded_all() const { return recorder == nullptr || recorder->health().unsent == 0; }

  std::unique_ptr<vehicle::LogRecorder> recorder;
  TrajectoryCollector collector;
  TrajectoryCollector lidar_collector;
  fusion_score::NavTrack track;
  std::optional<NavState> end;  // the last fused state
  std::optional<PppEpochs> ppp;
  std::map<Time, PppState> ppp_states;
  std::map<Time, match::TimedMatch> matches;
  std::map<Time, report::RoadMoment> road_moments;
};

// Files that a run can write of its fused states; empty: not.
struct StateFiles {
  std::filesystem::path poses;  // KITTI's format, of the left camera
  std::filesystem::path tum;
  std::filesystem::path csv;
  std::filesystem::path nmea;
};

// Writes each file by a function of its own; one that cannot be written is said on standard error,
// and the others are written all the same. Whether all were.
bool write_all(const std::vector<std::function<void()>>& writers);

// Throws std::runtime_error naming the file that cannot be written, or would be empty.
void write_states(const StateFiles& files, const RunPass& pass);

// The page of --report; `reference` is empty and `map` null where there is none.
void write_run_report(const std::filesystem::path& file, const ReplayResult& result,
                      const RunPass& pass, std::vector<ReferencePose> reference,
                      const vehicle::VehicleConfig& config, const vehicle::RoadMap* map);

// What the run says of itself at its end: the verdict, with the tables below it where they are
// asked for.
std::string closing_text(const ReplayResult& result, bool tables);

bool any_thread_failed(const ReplayResult& result);

}  // namespace maploop::tools
