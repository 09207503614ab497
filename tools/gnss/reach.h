// Tells how accurate the positions of a receiver become with the files that there are.
#pragma once

#include <string>

#include "ppp/gnss_files.h"

namespace maploop::gnss {

// Returns lines that name the level that the files reach together, and what they lack for more;
// empty if they contain not exactly one receiver's observations.
std::string reach(const ppp::GnssFiles& files);

}  // namespace maploop::gnss
