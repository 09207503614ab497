// Reads RINEX observation files 2.00 to 2.12 and 3.00 to 3.05, plain or Hatanaka-compressed (CRX 1
// and 3).
#pragma once

#include <functional>

#include "ppp/observations.h"

namespace maploop::ppp {

// Parses the text of one such file; its first line tells the format. An incomplete last epoch, an
// epoch that is not after the previous one, and a satellite or value that cannot be right are
// refused and counted. Anything else that is wrong throws ReadError with file and line.
Observations parse_observations(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
