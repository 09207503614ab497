// The PPP filter with and without the map over a part of a drive, moment by moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapmatch/network_builder.h"
#include "mapmatch/road_network.h"
#include "mapmatch/rule_bases.h"
#include "ppp/ppp_setup.h"
#include "tools/ppp/map_loop.h"
#include "tools/ppp/truth.h"

namespace maploop::experiments {

// A receiver's drive: its files, where it was, and the map.
struct PppDrive {
  std::string name, group;  // drives of one group are pooled
  ppp::GnssFiles files;
  std::unique_ptr<gnss::Truth> truth;
  mapmatch::MapExtract map;
  // By GPS second of the week, where it is known: the way of the map that is driven, or none.
  std::map<int, std::optional<std::int64_t>> driven;
};

struct PppDriveFiles {
  std::string name, group;
  std::filesystem::path folder, truth, map, labels;  // labels may be empty
  std::vector<std::filesystem::path> products;       // files and folders besides the folder
};
// Throws std::runtime_error naming the file.
PppDrive read_ppp_drive(const PppDriveFiles& files);

// What happens to the satellites of a part of a drive.
struct PppCase {
  double start = 0.0, length = 180.0;            // s of the drive; the filter begins at the start
  double blocked_from = 0.0, blocked_for = 0.0;  // s since then, without any satellite
};

// With and without the map at an epoch of the truth.
struct PppMoment {
  double time = 0.0;  // s since the start of the part
  bool moves = false;
  std::optional<bool> on_map;                            // where labels say it
  double across_free = 0.0, across_aided = 0.0;          // m
  double horizontal_free = 0.0, horizontal_aided = 0.0;  // m
  double sigma_free = 0.0;                               // m, across
  double apart = 0.0;  // of both, in standard deviations of that without the map; horizontal
  bool used = false;   // a feedback of this epoch
  std::uint64_t restorations = 0;
  bool paused = false;
};

struct PppSetting {
  const ppp::PppSetup* setup = nullptr;
  const gnss::Truth* truth = nullptr;
  const mapmatch::RoadNetwork* network = nullptr;
  const mapmatch::RuleBases* rules = nullptr;
  const std::map<int, std::optional<std::int64_t>>* driven = nullptr;
  mapmatch::MatchParameters match;
  mapmatch::FeedbackParameters feedback;
};

std::vector<PppMoment> run_case(const PppSetting& setting, const PppCase& c);

}  // namespace maploop::experiments
