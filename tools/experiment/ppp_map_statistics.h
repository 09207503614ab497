// What parts of drives say together: each part is one draw.
#pragma once

#include <functional>
#include <vector>

#include "tools/experiment/ppp_map_run.h"

namespace maploop::experiments {

using Part = std::vector<PppMoment>;

// With and without the map over the same moments; 95 % by bootstrap over the parts.
struct Reduction {
  double without = 0.0, with = 0.0;             // RMSE, m
  double percent = 0.0, low = 0.0, high = 0.0;  // less
  std::size_t parts = 0, moments = 0;
};

using Chosen = std::function<bool(const PppMoment&)>;

// Parts of so many seconds, as draws of a long one.
std::vector<Part> cut_into(const Part& part, double seconds);

// `across` the way, else horizontally; of the moments that are chosen.
Reduction reduction(const std::vector<Part>& parts, bool across, const Chosen& chosen);

// s from `from` on until the error across stays below the limit to the end of the part; the part's
// length where it does not. Means over the parts, and the mean difference with its 95 %.
struct TimeToStay {
  double without = 0.0, with = 0.0;
  double percent = 0.0, low = 0.0, high = 0.0;  // less
};
TimeToStay time_to_stay(const std::vector<Part>& parts, double limit, double from,
                        const Chosen& chosen);

// Ten seconds after each time that the map paused: how far the solution is from that without it.
struct Recovery {
  std::size_t pauses = 0, restorations = 0;
  double farthest = 0.0;  // in the standard deviations of that without the map, horizontal
};
Recovery recovery(const std::vector<Part>& parts);

}  // namespace maploop::experiments
