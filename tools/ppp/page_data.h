// This file makes the data that the page's script draws (tools/web/src/gnss_data.ts). Of a long run
// it keeps fewer epochs.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/ppp/summary.h"

namespace maploop::gnss {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The epochs of a run in the order of time. Where some are missing there is one more without a
// solution, so that lines have a gap there.
struct EpochRow {
  double second = 0.0;                         // since the first
  const ppp::PppSolution* solution = nullptr;  // nullptr: missing

  bool solved() const { return solution != nullptr && solution->has_position(); }
};
std::vector<EpochRow> epoch_rows(const Solutions& solutions);

struct Dilutions {
  double position = unknown, horizontal = unknown, vertical = unknown;
};
// By the geometry of the satellites used, as if they had one clock.
Dilutions dilutions(const ppp::PppSolution& solution);

nlohmann::json positions_json(const std::vector<EpochRow>& rows, const PppResult& result);
nlohmann::json satellites_json(const std::vector<EpochRow>& rows);

}  // namespace maploop::gnss
