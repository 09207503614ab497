// Experiments run recordings through the vehicle's own graph, on virtual time: any one, or a
// sequence of KITTI's odometry benchmark.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "tools/replay/fusion_score.h"

namespace maploop::experiments {

// How much of a sequence can be scored, and with what.
struct Sequence {
  const char* name;
  double duration;    // s
  double tracks_end;  // s into it that the recorded tracks are good for; 0: there are none
};
// The frames of 01 beyond 199 contradict the motion (a wrong stereo match in most of them).
inline constexpr std::array<Sequence, 8> sequences{{{"00", 470.0, 0.0},
                                                    {"01", 114.0, 20.4},
                                                    {"02", 483.0, 0.0},
                                                    {"03", 82.0, 0.0},
                                                    {"04", 28.0, 0.0},
                                                    {"06", 114.0, 103.5},
                                                    {"08", 422.0, 0.0},
                                                    {"10", 124.0, 0.0}}};

// What is set about one run.
struct SequenceCase {
  std::string sequence;  // "06"
  std::string configuration = "GNSS+RISS";
  bool mems = false;         // noise of such a unit is added
  double speed_scale = 0.0;  // of the wheels: how much more than the true speed they read
  std::string outages;       // as --gnss-outage; empty: dead reckoning from the reference's start
  double end = 0.0;          // s into the drive; 0: the whole
  std::int64_t seed = 1;

  std::string unit() const { return mems ? "mems" : "recorded"; }
};

struct RecordingRun {
  vehicle::Recording recording;
  fusion_score::NavTrack track;
  std::vector<ReferencePose> reference;
  vehicle::VehicleReport report;
};

struct SequenceRun : RecordingRun {
  fusion_score::Score score;
};

// How a recording is run.
struct RunOptions {
  bool from_reference = false;  // the filter starts from the reference, not from a fix
  double end = 0.0;             // s into the drive; 0: the whole
  std::vector<vehicle::MessageSink*> sinks{};
  // Asked every few milliseconds, where it is set; false ends the run.
  std::function<bool()> go_on{};
};

// Runs any recording, which was opened with `config`.
RecordingRun run_recording(vehicle::Recording recording, const vehicle::VehicleConfig& config,
                           const RunOptions& options = {}, vehicle::Observer observer = {},
                           std::shared_ptr<const vehicle::RoadMap> map = nullptr);

// `config` with what the case sets.
vehicle::VehicleConfig config_of(vehicle::VehicleConfig config, const SequenceCase& setup);

// Runs the sequence of `folder` (kitti_odometry) with a configuration made by config_of(). Throws
// std::runtime_error naming a file that cannot be read, or a sequence that cannot be scored.
SequenceRun run_sequence(const std::filesystem::path& folder, const SequenceCase& setup,
                         const vehicle::VehicleConfig& config, vehicle::Observer observer = {},
                         std::shared_ptr<const vehicle::RoadMap> map = nullptr);

// Returns the result of run(c) for each case; a line on standard error tells which one runs, by
// name(c).
template <class Case, class Name, class Run>
auto run_all(const std::vector<Case>& cases, Name&& name, Run&& run) {
  std::vector<decltype(run(cases.front()))> results;
  for (const Case& c : cases) {
    std::cerr << "\r" << results.size() + 1 << " of " << cases.size() << ": " << name(c)
              << "        " << std::flush;
    results.push_back(run(c));
  }
  std::cerr << '\n';
  return results;
}

}  // namespace maploop::experiments
