// Reads Hatanaka's compact RINEX, versions 1 and 3 (Hatanaka 2008: A compression format and tools
// for GNSS observation data): integers are differences in time, texts are differences to the
// previous line.
#pragma once

#include "ppp/observations.h"
#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

bool is_compact(std::string_view first_line);

// Reads as parse_observations() describes. Behind an epoch that cannot be read, those that refer to
// it are left out, too.
void read_compact(Lines& lines, Observations& result);

}  // namespace maploop::ppp
