// Tells how a run of precise point positioning went, as lines of text and as JSON.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/ppp/map_comparison.h"
#include "tools/ppp/other_solution.h"
#include "tools/ppp/position_files.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::gnss {

// A PppResult contains the solutions of a run and their score, from which its texts and files are
// made.
struct PppResult {
  Solutions solutions;
  std::size_t solved = 0, bridged = 0, matched = 0;
  std::unique_ptr<Truth> truth;
  std::unique_ptr<Score> score, without_map;  // where there is a truth; the second: and a map
  std::unique_ptr<MapComparison> comparison;  // as the second
  std::optional<ppp::GpsTime> scored_from;
  std::vector<OtherSolution> others;  // forward and backward, without the map, of files
};

std::vector<std::string> summary_lines(const PppRun& run, const PppResult& r, double integrity_risk,
                                       bool on_map, const ppp::GnssFiles& files);
nlohmann::json to_json(const PppRun& run, const PppResult& r, bool on_map);

}  // namespace maploop::gnss
