// Writes what agencies would publish about the constellation; each product has its own errors.
#pragma once

#include <cstdint>
#include <string>

#include "ppp/gps_time.h"
#include "tools/simulate/gnss/constellation.h"

namespace maploop::simulate {

// A drive that starts at `start` and takes `seconds`.
struct ProductSpan {
  ppp::GpsTime start;
  double seconds;
};

// RINEX 3.04 navigation messages: GPS every two hours, Galileo every ten minutes. They are wrong by
// 1 m along the orbit and 0.4 m in clock (GPS), 0.3 and 0.2 m (Galileo); the Klobuchar coefficients
// are those of another day.
std::string navigation_text(const Constellation& constellation, const ProductSpan& span,
                            std::uint64_t seed);
// SP3-c orbits every five minutes, wrong by 12 mm on each axis.
std::string orbit_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed);
// RINEX 3.00 clocks every 30 s, wrong by 15 mm.
std::string clock_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed);
// ANTEX 1.4 calibrations of satellites and receiver.
std::string antenna_text(const Constellation& constellation);

}  // namespace maploop::simulate
