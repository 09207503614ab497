// Decodes corrections of broadcast orbits and clocks: SSR of RTCM 3 (GPS 1057 to 1062, GLONASS 1063
// to 1068, Galileo 1240 to 1245, QZSS 1246 to 1251; phase biases 1265 to 1268; ionosphere 1264) and
// of the IGS (4076).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/readers/streams/rtcm3_frames.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// The offset must be subtracted from the position of the antenna's phase centre that the message
// with this issue gives; m, m/s.
struct SsrOrbit {
  int issue = 0;                    // lowest 8 bits of the broadcast message's issue
  Eigen::Vector3d offset{0, 0, 0};  // radial, along, across
  Eigen::Vector3d offset_rate{0, 0, 0};
};

// The polynomial must be added to the clock of that message; m, m/s, m/s^2.
struct SsrClock {
  std::array<double, 3> polynomial{};
};

// The bias must be added to the code of this signal; m.
struct SsrBias {
  char band = 0, attribute = 0;
  double value = 0.0;
};

// The bias must be added to the phase of this signal; m.
struct SsrPhaseBias {
  char band = 0, attribute = 0;
  double value = 0.0;
  bool integer = false;   // the ambiguity of the corrected phase is an integer
  int discontinuity = 0;  // counts the jumps of the bias: the ambiguity restarts when it changes
};

// An SsrHeader is what each message begins with, behind its number.
struct SsrHeader {
  GpsTime time{};              // time to which the content refers
  Duration interval{};         // time until the next one
  std::uint32_t solution = 0;  // provider and solution; those of two must not be combined
  int issue = 0;               // issue of the solution: orbit and clock of one belong together
};

// An SsrUpdate is the content of one message for one satellite.
struct SsrUpdate : SsrHeader {
  Satellite satellite;
  std::optional<SsrOrbit> orbit;
  std::optional<SsrClock> clock;
  std::optional<double> high_rate_clock;  // m, added to the clock
  std::optional<double> sigma;            // m, of the range (URA)
  bool has_biases = false;
  std::vector<SsrBias> biases;
  bool has_phase_biases = false;
  std::vector<SsrPhaseBias> phase_biases;
};

// A layer of electrons is expanded in spherical harmonics of a longitude that turns with the sun.
// The coefficients (TECU) come by order m from 0 (sines from 1), then by degree n from m.
struct SsrLayer {
  int degree = 1, order = 1;
  std::vector<double> cosines, sines;
};

// This is the content of a message of the ionosphere.
struct SsrIonosphere : SsrHeader {
  double sigma = 0.0;  // TECU, of the vertical content; 0: unknown
  std::vector<SsrLayer> layers;
};

enum class SsrResult : std::uint8_t { none, decoded, incomplete, unsupported };

// Adds the content of a message to `to`, or replaces `ionosphere`. `now` is a moment that differs
// from the reception by less than half a day. The result is `none` if it is not an SSR message,
// `incomplete` if its content is incomplete (nothing is added then), and `unsupported` for other
// systems.
SsrResult decode_ssr(const Rtcm3Message& message, GpsTime now, std::vector<SsrUpdate>& to,
                     std::optional<SsrIonosphere>& ionosphere);

}  // namespace maploop::ppp
