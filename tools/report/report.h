// Writes the results of one replay as a page.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mapmatch/road_network.h"
#include "msgs/map_match.h"
#include "msgs/ppp_state.h"
#include "msgs/reference.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/replay/fusion_score.h"
#include "tools/replay/replay_result.h"
#include "tools/web/plot.h"

namespace maploop::report {

// A path of the body in its own first frame, for instance that of odometry.
struct DeadReckoning {
  std::string name;
  evaluation::StampedTrajectory trajectory;
};

// The matcher's result at one time.
struct RoadMoment {
  MatchPhase phase = MatchPhase::initial;
  bool on_road = false;      // if true, the values below are those of the link
  Geodetic place;            // matched position
  double probability = 0.0;  // P(link)
};

RoadMoment road_moment(const MapMatch& match);

struct ReplayReport {
  const tools::ReplayResult& result;
  const fusion_score::NavTrack& track;
  std::vector<ReferencePose> reference;  // empty if the recording has none
  std::vector<DeadReckoning> dead_reckoning;
  const std::map<Time, RoadMoment>& matches;  // empty if nothing was matched
  const std::map<Time, PppState>& ppp;        // empty if there were no observations
  Eigen::Vector3d antenna;    // m, body frame (forward, left, up): the point that PPP positions
  std::string configuration;  // TOML
  std::string version;        // of maploop
  const mapmatch::RoadNetwork* roads = nullptr;  // nullptr if there was no map
};

// Writes one HTML page. Throws std::runtime_error naming the file if it cannot be written.
void write_report(const std::filesystem::path& file, const ReplayReport& report);

}  // namespace maploop::report
