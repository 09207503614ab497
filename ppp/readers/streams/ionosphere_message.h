// Defines the ionospheric coefficients that satellites broadcast.
#pragma once

#include <array>
#include <variant>

#include "ppp/gps_time.h"

namespace maploop::ppp {

// These are GPS's alpha 0 to 3 and beta 0 to 3, in s and semicircles as in IS-GPS-200.
struct Klobuchar {
  std::array<double, 8> values{};
  void archive(auto& ar) { ar(values); }
  bool operator==(const Klobuchar&) const = default;
};

// These are ai0 to ai2 of Galileo's effective ionisation level, in solar flux units, and these per
// degree and per degree squared, as in the OS SIS ICD.
struct IonisationLevel {
  std::array<double, 3> values{};
  void archive(auto& ar) { ar(values); }
  bool operator==(const IonisationLevel&) const = default;
};

using IonosphereCoefficients = std::variant<Klobuchar, IonisationLevel>;

// These are the coefficients and the period in which they were sent. A RINEX header does not
// contain that period: it is then that from the first to the last message of the file.
struct IonosphereMessage {
  IonosphereCoefficients coefficients;
  GpsTime first{}, last{};
  void archive(auto& ar) { ar(coefficients, first, last); }
};

}  // namespace maploop::ppp
