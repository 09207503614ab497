// Reads RINEX observation files 2.00 to 2.12 and 3.00 to 3.05, plain or Hatanaka-compressed (CRX 1
// and 3).
#pragma once

#include <functional>

#include "ppp/observations.h"

namespace maploop::ppp {

// Parses the text of one such file, or of several one after another; its first line tells the
// format. An epoch that cannot be read or is not after the previous one, and a satellite or value
// that cannot be right, are refused and counted. Throws ReadError with file and line if the header
// or more than half of the rest cannot be read.
Observations parse_observations(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
