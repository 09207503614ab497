// The pictures of a profile, as SVG that takes its colours from the page's style.
#pragma once

#include <string>
#include <vector>

#include "msgs/diagnostics.h"
#include "tools/profile/profile.h"

namespace maploop::profile {

struct Curve {
  std::string role;  // class of the style: "latency", "corrected", "wake-up", ...
  HistogramData histogram;
};

// The share of values longer than a time, both axes logarithmic. deadline 0: none.
std::string latency_chart(const std::string& title, const std::vector<Curve>& curves,
                          Duration deadline);

// One bar a miss in the order of their stamps, from release to result, in its parts. What a path
// was allowed is grey. Part i of `names` has the style's class "part-i".
std::string miss_chart(std::vector<WorstMiss> worst, const std::vector<std::string>& names,
                       Time end);

}  // namespace maploop::profile
