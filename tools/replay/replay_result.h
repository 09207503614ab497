// What one run came to: accuracy against the reference, and how the runtime did; as three lines, as
// tables, and as JSON.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "msgs/map_feedback.h"
#include "msgs/nav_state.h"
#include "msgs/ppp_state.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/graph/vehicle_report.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "tools/evaluate/kitti_metric.h"
#include "tools/match/match_score.h"
#include "tools/replay/fusion_score.h"
#include "tools/replay/outage_score.h"
#include "tools/replay/protection_score.h"

namespace maploop::tools {

// Of one trajectory, at the images where it and the reference have a pose.
struct Accuracy {
  evaluation::Score raw;
  evaluation::Score common_rotation_removed;
};

// A snapshot that was taken on the way, and the channels from there on: what a run that resumes
// from it must have.
struct SnapshotResult {
  std::string file;
  double at = 0.0;  // s since the first sample
  std::map<std::string, vehicle::ChannelSummary> channels;
};

struct TraceSummary {
  std::string file;
  std::uint64_t recorded = 0;  // events
  std::uint64_t dropped = 0;
};

// Of a drive with GNSS observations: its epochs by what the ppp thread said of them.
struct PppEpochs {
  std::array<std::size_t, count_of<PppStatus>> by_status{};
  double converged_after = -1.0;  // s, of the first that was; below 0: none
  bool never_converges = false;   // ppp::PppSetup::never_converges()

  PppEpochs() = default;
  explicit PppEpochs(const std::map<Time, PppState>& states) {
    for (const auto& [stamp, state] : states) {
      ++by_status[static_cast<std::size_t>(state.status)];
      if (state.status >= PppStatus::converged && converged_after < 0.0)
        converged_after = state.converging_for;
    }
  }
  std::size_t of(PppStatus status) const { return by_status[static_cast<std::size_t>(status)]; }
};

// Of a run on a map.
struct MapUse {
  std::string area;        // that the map covers
  bool elsewhere = false;  // no position was on a road, and the run ended far outside of the map
};

struct ReplayResult {
  std::string run;            // its id (runtime/vehicle/output/runs.h)
  std::string drive;          // or a live run's configuration
  std::string configuration;  // of the fusion, by name
  bool live = false;          // no replay at all
  bool lockstep = false;
  double speed = 1.0;
  bool interrupted = false;
  std::size_t images = 0;         // of the drive
  bool has_gnss = true;           // the recording has fixes or observations
  std::optional<NavState> end;    // the last fused state; nothing: the filter never started
  double without_position = 0.0;  // s after the first position in which there was none
  std::optional<MapUse> map;
  std::optional<Accuracy> vo;  // nothing where there is too little to score
  std::optional<Accuracy> lidar;
  std::optional<Accuracy> fused;  // in the frame of the map
  std::optional<Accuracy> odom;   // the same in the frame of odometry
  std::optional<PppEpochs> ppp;
  std::optional<fusion_score::Score> navigation;  // of NAV_STATE, as it was sent
  std::optional<fusion_score::ProtectionScore> protection;
  bool peer_reference = false;                       // of vehicle::Recording
  std::vector<fusion_score::OutageEnd> outage_ends;  // where the recording has fixes to score with
  std::optional<match::MatchScore> links;            // of MAP_MATCH, where the links are known
  std::array<std::uint64_t, count_of<FeedbackReason>> feedbacks{};  // of the map, by reason
  std::map<std::string, vehicle::ChannelSummary> channels;
  std::optional<SnapshotResult> snapshot;
  std::vector<vehicle::FaultCount> faults;
  Time begin{};  // of the drive
  std::optional<TraceSummary> trace;
  vehicle::VehicleReport vehicle;

  std::uint64_t samples_lost() const {  // in rings
    return sum(vehicle.health.rings, &RingHealth::lost);
  }
  std::uint64_t messages_unsent() const {  // that LCM or the log did not take
    return sum(vehicle.health.outputs, &OutputHealth::unsent);
  }
  std::uint64_t deadline_misses() const {
    return sum(vehicle.deadlines.threads, &LatencySummary::misses);
  }
  bool any_thread_failed() const {
    const auto& threads = vehicle.health.threads;
    return std::any_of(threads.begin(), threads.end(),
                       [](const ThreadHealth& t) { return !t.failure.empty(); });
  }

 private:
  template <class Item>
  static std::uint64_t sum(const std::vector<Item>& items, std::uint64_t Item::*count) {
    std::uint64_t all = 0;
    for (const Item& item : items) all += item.*count;
    return all;
  }
};

// Where the run ended; how good its positions are, and against what; what the configuration did not
// use, and why. Lines without their ends, each of at most 79 columns.
std::array<std::string, 3> verdict(const ReplayResult& result);

// The same as one text, each line with its end.
std::string verdict_text(const ReplayResult& result);

// The reason and the remedy where the run has no result: no position, or none on a road of its map.
// Nothing where it has one, where it was interrupted, and for a live run to which a sensor spoke. A
// capture of a LiDAR alone has its odometry for a result.
std::optional<std::string> why_empty(const ReplayResult& result);

// For a person, on a terminal: everything that was measured.
std::string format_table(const ReplayResult& result);

// The same for a program; numbers that are not finite become null.
nlohmann::json to_json(const ReplayResult& result);

// Throws std::runtime_error naming the file when it cannot be written.
void write_json(const std::filesystem::path& file, const ReplayResult& result);

}  // namespace maploop::tools
