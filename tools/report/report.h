// What one replay came to, as a page for people.
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

// What the matcher said at one moment.
struct RoadMoment {
  MatchPhase phase = MatchPhase::initial;
  bool on_road = false;      // the rest is about the link
  Geodetic place;            // matched
  double probability = 0.0;  // P(link)
};

RoadMoment road_moment(const MapMatch& match);

struct ReplayReport {
  const tools::ReplayResult& result;
  const fusion_score::NavTrack& track;
  std::vector<ReferencePose> reference;  // empty: the recording has none
  std::vector<DeadReckoning> dead_reckoning;
  const std::map<Time, RoadMoment>& matches;     // empty: nothing was matched
  const std::map<Time, PppState>& ppp;           // empty: there were no observations
  Eigen::Vector3d antenna;                       // m, of the body, forward left up: PPP's position
  std::string configuration;                     // TOML
  std::string version;                           // of maploop
  const mapmatch::RoadNetwork* roads = nullptr;  // nullptr: there was no map
};

// Writes one HTML page. Throws std::runtime_error naming the file when it cannot be written.
void write_report(const std::filesystem::path& file, const ReplayReport& report);

}  // namespace maploop::report
