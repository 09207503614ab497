// The pictures of a profile.
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

// The share of values longer than a time, both axes logarithmic. deadline 0: none.
web::Plot latency_plot(const std::string& title, const std::vector<Curve>& curves,
                       Duration deadline);

// HTML: one bar a miss in the order of their stamps, from release to result, in its parts. What a
// path was allowed is grey.
std::string miss_bars(std::vector<WorstMiss> worst, Time end);

}  // namespace maploop::profile
