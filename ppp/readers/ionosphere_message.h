// What satellites broadcast of the ionosphere.
#pragma once

#include <array>
#include <variant>

#include "ppp/gps_time.h"

namespace maploop::ppp {

// Of GPS: alpha 0 to 3, beta 0 to 3. s and semicircles, as IS-GPS-200 writes them.
struct Klobuchar {
  std::array<double, 8> values{};
  bool operator==(const Klobuchar&) const = default;
};

// Of Galileo, the effective ionisation level: ai0 to ai2. Solar flux units, and these by degree
// and by degree squared, as the OS SIS ICD writes them.
struct IonisationLevel {
  std::array<double, 3> values{};
  bool operator==(const IonisationLevel&) const = default;
};

using IonosphereCoefficients = std::variant<Klobuchar, IonisationLevel>;

// The coefficients, and from when to when they were sent. A RINEX header does not say when: there
// it is from the first to the last message of its file.
struct IonosphereMessage {
  IonosphereCoefficients coefficients;
  GpsTime first{}, last{};
};

}  // namespace maploop::ppp
