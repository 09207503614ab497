// Draws the pictures of a profile.
#pragma once

#include <string>
#include <vector>

#include "msgs/diagnostics.h"
#include "tools/profile/profile.h"
#include "tools/web/plot.h"

namespace maploop::profile {

struct Curve {
  std::string name;
  HistogramData histogram;
};

// Plots the share of values longer than a time, with both axes logarithmic. `deadline` 0: none.
web::Plot latency_plot(const std::string& title, const std::vector<Curve>& curves,
                       Duration deadline);

// Returns HTML with one bar for each miss in the order of their stamps, from release to result,
// divided into its parts. The time that the graph allows a path is grey.
std::string miss_bars(std::vector<WorstMiss> worst, Time end);

}  // namespace maploop::profile
