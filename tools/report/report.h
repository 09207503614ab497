// What one replay came to, as a page for people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapmatch/road_network.h"
#include "msgs/reference.h"
#include "tools/evaluation/trajectory_file.h"
#include "tools/fusion_score.h"
#include "tools/replay_result.h"
#include "tools/web/plot.h"

namespace maploop::report {

// A way of the body in its own first frame, such as odometry's.
struct DeadReckoning {
  std::string name;
  evaluation::StampedTrajectory trajectory;
};

struct ReplayReport {
  const tools::ReplayResult& result;
  const fusion_score::NavTrack& track;
  std::vector<ReferencePose> reference;  // empty: the recording has none
  std::vector<DeadReckoning> dead_reckoning;
  std::string configuration;                     // TOML
  std::string version;                           // of maploop
  const mapmatch::RoadNetwork* roads = nullptr;  // nullptr: there was no map
};

// Writes one HTML page. Throws std::runtime_error naming the file when it cannot be written.
void write_report(const std::filesystem::path& file, const ReplayReport& report);

}  // namespace maploop::report
