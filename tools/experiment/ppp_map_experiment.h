// What the map gives the PPP filter: cold starts, starts anew behind tunnels, few satellites, and
// wrong maps; the same filter without the map at the same moments.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/ppp_map_run.h"
#include "tools/experiment/ppp_map_statistics.h"
#include "tools/experiment/table.h"

namespace maploop::experiments {

struct PppMapOptions {
  ppp::SetupOptions setup;
  mapmatch::MatchParameters match;
  mapmatch::FeedbackParameters feedback;
  int starts = 20;        // of each drive and case, evenly over it
  double length = 180.0;  // s of each
  double tunnel = 30.0;   // s without satellites behind the length, and the length again
  double few = 40.0;      // degrees; the case of few satellites has none below
  double useful = 0.59;   // m, of the deviation across without the map, where goals are counted
};

// One case of one group of drives, or one wrong map of one drive.
struct PppMapResult {
  std::string group, name;
  std::vector<Part> parts;
  double from = 0.0;  // s of a part, where the figures begin
};

// The whole of each drive on its map and on wrong ones, then the cases. `progress` is told what
// comes.
std::vector<PppMapResult> compare_ppp_map(const std::vector<PppDrive>& drives,
                                          const mapmatch::RuleBases& rules,
                                          const PppMapOptions& options,
                                          const std::function<void(const std::string&)>& progress);

std::string to_text(const std::vector<PppMapResult>& results, const PppMapOptions& options);
std::string to_html(const std::vector<PppMapResult>& results, const PppMapOptions& options);

}  // namespace maploop::experiments
