// Reads the times that an option of maploop ppp chooses.
#pragma once

#include <string>

#include "ppp/gps_time.h"

namespace maploop::gnss {

// Both read "2020-06-25 01:00:00" of GPS time, or "01:00:00" of the day of `first`, the first
// epoch, or seconds since then. They throw std::runtime_error, which names the option.

// Returns the epoch from which on something is done. A time of day before the first epoch is that
// of the next day, where there are epochs then; `last` is the last one.
ppp::GpsTime beginning(const std::string& text, const std::string& option, ppp::GpsTime first,
                       ppp::GpsTime last);

// Returns the end of what begins at `start`. A time of day before that is that of the next day, if
// there are epochs on it.
ppp::GpsTime ending(const std::string& text, const std::string& option, ppp::GpsTime first,
                    ppp::GpsTime start, ppp::GpsTime last);

}  // namespace maploop::gnss
