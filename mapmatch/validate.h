// What parameters can be used.
#pragma once

#include "mapmatch/match_parameters.h"

namespace maploop::mapmatch {

// Throws std::invalid_argument naming the value.
void validate(const MatchParameters& parameters);

}  // namespace maploop::mapmatch
