// One replay of a recording: what it was asked for, and how it runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault.h"
#include "tools/match/map_faults.h"
#include "tools/replay/misdescription.h"
#include "tools/replay/replay_console.h"
#include "tools/replay/run_output.h"

namespace maploop::tools {

// Where a snapshot is to be taken, and its file.
struct SnapshotRequest {
  double seconds = 0.0;  // into the drive
  std::filesystem::path file;
};

struct ReplayOptions : RunOptions {
  std::filesystem::path drive;
  double speed = 1.0;
  bool lockstep = false;
  std::string configuration;
  std::string gnss_outage;
  std::filesystem::path odometry_poses;
  std::vector<std::string> topics;  // SENSOR=TOPIC
  std::string imu;
  std::optional<double> speed_scale;  // 1.01: the wheels read 1 % too much
  bool start_from_reference = false;
  std::optional<std::int64_t> seed;
  std::vector<vehicle::Fault> faults;
  std::optional<match::MapFault> map_fault;
  std::optional<Property> misdescribed;
  double score_from = 0.0;      // s into the drive
  std::filesystem::path truth;  // of the left camera; empty: the recording's reference
  std::optional<SnapshotRequest> snapshot;
  std::filesystem::path resume;
  PlaybackOptions playback;
  std::uint64_t loop = 1;  // 0: for ever
  double start = 0.0;      // s into the drive
  double end = 0.0;        // s; 0: the whole drive
};

// Plays the recording to its end, prints the verdict and writes the files asked for. Returns the
// command's exit status: 1 when there is no position (or none on the map), a thread failed, the
// snapshot was not reached or the log does not hold everything, 130 when interrupted. Throws
// std::runtime_error naming the file that cannot be read or written.
int replay(const ReplayOptions& options);

}  // namespace maploop::tools
