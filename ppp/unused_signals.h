// Tells which observations of a file cannot contribute to a position.
#pragma once

#include <string>
#include <vector>

#include "ppp/observations.h"

namespace maploop::ppp {

// Returns a sentence for each system of which the file's header has columns, but none with a code
// on the system's first carrier (`bands_of`), without which a satellite is not used.
std::vector<std::string> unused_systems(const ObservationHeader& header);

}  // namespace maploop::ppp
