// What parameters can be used.
#pragma once

#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// Throws std::invalid_argument naming the key, its value and what it may be.
void validate(const PppParameters& parameters);

}  // namespace maploop::ppp
