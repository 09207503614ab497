// What parameters can be used.
#pragma once

#include "mapmatch/match_parameters.h"

namespace maploop::mapmatch {

// Throws std::invalid_argument naming the key, its value and its range.
void validate(const MatchParameters& parameters);

}  // namespace maploop::mapmatch
