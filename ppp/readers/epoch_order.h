#pragma once

#include "ppp/gps_time.h"

namespace maploop::ppp {

// Whether a receiver sends an epoch again, or late. One that was wrong about its date says a far
// earlier one from then on: that is none.
inline bool is_repeated(GpsTime epoch, GpsTime last) {
  return epoch <= last && last - epoch <= std::chrono::seconds(10);
}

}  // namespace maploop::ppp
