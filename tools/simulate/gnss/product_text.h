// What agencies would say of the constellation: each product with errors of its own.
#pragma once

#include <cstdint>
#include <string>

#include "ppp/gps_time.h"
#include "tools/simulate/gnss/constellation.h"

namespace maploop::simulate {

// Of a drive that starts at `start` and takes `seconds`.
struct ProductSpan {
  ppp::GpsTime start;
  double seconds;
};

// RINEX 3.04 navigation messages: GPS every two hours, Galileo every ten minutes. Off by 1 m along
// and 0.4 m in clock (GPS), 0.3 and 0.2 m (Galileo); with Klobuchar's coefficients of another day.
std::string navigation_text(const Constellation& constellation, const ProductSpan& span,
                            std::uint64_t seed);
// SP3-c each five minutes, off by 12 mm an axis.
std::string orbit_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed);
// RINEX clocks 3.00 each 30 s, off by 15 mm.
std::string clock_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed);
// ANTEX 1.4 of satellites and receiver.
std::string antenna_text(const Constellation& constellation);

}  // namespace maploop::simulate
