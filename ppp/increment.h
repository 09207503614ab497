// Separates what an epoch of a carried receiver has measured from what carried it.
#pragma once

#include <optional>

#include "msgs/gnss.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// Returns the measurement that leads from what the filter knew before the epoch to its solution,
// (28) of METHOD.md. Returns nothing for a solution that is not carried.
std::optional<GnssIncrement> increment_of(const PppSolution& solution);

}  // namespace maploop::ppp
