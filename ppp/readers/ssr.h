// Corrections of broadcast orbits and clocks: SSR of RTCM 3 (GPS 1057 to 1062, GLONASS 1063 to
// 1068, Galileo 1240 to 1245, QZSS 1246 to 1251) and of the IGS (4076).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/readers/rtcm3_frames.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// Of the antenna's phase centre, what to take off the position that the message with this issue
// gives; m, m/s.
struct SsrOrbit {
  int issue = 0;                    // of the broadcast message, its lowest 8 bits
  Eigen::Vector3d offset{0, 0, 0};  // radial, along, across
  Eigen::Vector3d offset_rate{0, 0, 0};
};

// What to add to the clock of that message, as a polynomial; m, m/s, m/s^2.
struct SsrClock {
  std::array<double, 3> polynomial{};
};

// What to add to the code of this signal; m.
struct SsrBias {
  char band = 0, attribute = 0;
  double value = 0.0;
};

// What one message says of one satellite.
struct SsrUpdate {
  Satellite satellite;
  GpsTime time{};              // that the corrections are counted from
  Duration interval{};         // until the next one
  std::uint32_t solution = 0;  // provider and solution: those of two do not go together
  int issue = 0;               // of the solution: orbit and clock of one go together
  std::optional<SsrOrbit> orbit;
  std::optional<SsrClock> clock;
  std::optional<double> high_rate_clock;  // m, besides the clock
  std::optional<double> sigma;            // m, of the range (URA)
  bool has_biases = false;
  std::vector<SsrBias> biases;
};

enum class SsrResult : std::uint8_t { none, decoded, damaged, unsupported };

// Adds what a message says to `to`. `now`: a moment of the reception to within half a day. None: it
// is no SSR message; damaged: it has not the content that it says, and nothing is added;
// unsupported: phase biases, ionosphere, other systems.
SsrResult decode_ssr(const Rtcm3Message& message, GpsTime now, std::vector<SsrUpdate>& to);

}  // namespace maploop::ppp
