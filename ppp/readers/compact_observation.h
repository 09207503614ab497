// Hatanaka's compact RINEX, versions 1 and 3 (Hatanaka 2008: A compression format and tools for
// GNSS observation data): integers as differences in time, texts as differences to the line before.
#pragma once

#include "ppp/observations.h"
#include "ppp/readers/lines.h"

namespace maploop::ppp {

bool is_compact(std::string_view first_line);

// As parse_observations says; a difference that has nothing to refer to throws ReadError.
void read_compact(Lines& lines, Observations& result);

}  // namespace maploop::ppp
