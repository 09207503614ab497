// The map in the loop, on the sequences of KITTI's odometry benchmark: dead reckoning behind a
// short stretch with GNSS, without the map, beside it and with its feedback.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mapmatch/network_builder.h"
#include "msgs/map_feedback.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tools/experiment/sequence_run.h"
#include "tools/match/match_score.h"

namespace maploop::experiments {

using vehicle::MapMode;

// One run of one sequence: of a MEMS unit, wheels that read 1 % too much and 10 s of GNSS, unless
// something else is set.
struct MapCase : SequenceCase {
  MapCase() {
    mems = true;
    speed_scale = 0.01;
    outages = "10:end";
  }

  MapMode mode = MapMode::tight;
  std::string fault;  // one of map_faults(), or empty: the map as it is
};

// What can be made wrong in a map: the way driven longest is missing, everything is shifted east by
// 5 or 10 m, one-way streets are reversed, a road 12 m beside each one driven is made up.
const std::vector<std::string>& map_faults();

// Everything that the runs have in common.
struct MapSetting {
  std::filesystem::path folder;  // kitti_odometry
  vehicle::VehicleConfig config;
  std::shared_ptr<const vehicle::RoadMap> roads;
  const mapmatch::MapExtract* extract = nullptr;  // the same map, that faults are made in
};

// At one tick, where there is a reference.
struct MapSample {
  double time = 0.0;                                // s into the drive
  Eigen::Vector2d truth = Eigen::Vector2d::Zero();  // m, enu of the drive
  Eigen::Vector2d error = Eigen::Vector2d::Zero();  // m
  double azimuth = 0.0;                             // rad, true
  double azimuth_error = 0.0;                       // rad
  double sigma = 0.0;                               // m, horizontal, as the filter says
  double nees = 0.0;
  bool on_missing = false;   // on the way that the map lacks
  double probability = 0.0;  // P(link)
  FeedbackReason reason = FeedbackReason::no_fix;
};

struct MapResult {
  MapCase setup;
  fusion_score::Score score;
  Geodetic origin;
  std::vector<MapSample> samples;
  match::MatchScore match;   // of the time without GNSS
  std::int64_t missing = 0;  // the way that the map lacks
  std::array<std::size_t, count_of<FeedbackReason>> reasons{};
  std::uint64_t gated = 0;         // feedbacks that contradicted the prediction
  std::uint64_t restorations = 0;  // times what the map had led to was undone
};

// What is to be compared: every combination that there is data for.
struct MapCases {
  std::vector<std::string> sequences{"00", "01", "02", "03", "04", "06", "08", "10"};
  std::vector<MapMode> modes{MapMode::none, MapMode::loose, MapMode::tight, MapMode::hard_reset};
  std::vector<std::string> units{"mems"};
  std::vector<std::string> configurations{"GNSS+RISS"};
  std::vector<std::string> outages{"10:end"};
  std::vector<std::string> faults;  // beside the map as it is
  bool poses = false;  // a trajectory stands for visual odometry, in place of recorded tracks
  double speed_scale = 1.01;
  int seeds = 1;
};

std::vector<MapCase> map_cases(const MapCases& wanted);

// Throws as run_sequence().
MapResult run(const MapSetting& setting, const MapCase& setup);

// Of the first time without GNSS; of the whole drive where there is none.
const fusion_score::Errors& without_gnss(const MapResult& result);

// One run beside the run without the map, at the same moments.
struct Comparison {
  double worse = 0.0;         // share of the time with more than twice its error and its sigma
  double worst_excess = 0.0;  // m, beyond that
  double probability_on_missing = 0.0;  // P(link), mean, on the way that the map lacks
  double probability = 0.0;             // and elsewhere
};
Comparison compare(const MapResult& aided, const MapResult& free);

std::string to_text(const std::vector<MapResult>& results);
// One self-contained page.
std::string to_html(const MapSetting& setting, const std::vector<MapResult>& results);

}  // namespace maploop::experiments
