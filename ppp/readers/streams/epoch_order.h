#pragma once

#include "ppp/gps_time.h"

namespace maploop::ppp {

// Returns whether a receiver repeats an epoch or sends it late: at most 10 s before `last`. An
// epoch that is much earlier does not count as repeated, because the receiver has then corrected a
// wrong date.
inline bool is_repeated(GpsTime epoch, GpsTime last) {
  return epoch <= last && last - epoch <= std::chrono::seconds(10);
}

}  // namespace maploop::ppp
