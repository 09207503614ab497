// This file estimates how long one step of a thread takes at most, from the steps that were
// measured.
#pragma once

#include <cstdint>

#include "msgs/diagnostics.h"

namespace maploop::analyze {

// Times are in ms.
struct ExecutionBound {
  double observed = 0.0;          // the longest one
  double bound = 0.0;             // never below it
  std::uint64_t exceedances = 0;  // on which the tail was fitted
  double distance = 0.0;          // Kolmogorov's, of the fitted tail from the measured one
  bool fitted = false;            // whether the fit was good enough to be used
};

struct BoundParameters {
  double probability = 1e-6;  // that a step takes longer, where the tail was fitted
  double margin = 1.2;        // on the longest one, where it was not
};

// The excesses over the 90th percentile are given a generalized Pareto distribution by its moments
// (Hosking and Wallis, Technometrics 29, 1987), if there are at least 30 of them. The fit is used
// if the distance is below 1.36 / sqrt(exceedances), Kolmogorov's limit at 5 %.
ExecutionBound execution_bound(const LatencySummary& execution, const BoundParameters& parameters);

}  // namespace maploop::analyze
