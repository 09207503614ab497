// This file tells which navigation messages can be right, and limits and refuses them.
#include <cmath>
#include <utility>

#include "ppp/readers/files/navigation.h"

namespace maploop::ppp {

void BroadcastMessages::take(BroadcastMessages& from) {
  std::swap(kepler, from.kepler);
  std::swap(glonass, from.glonass);
  std::swap(ionosphere, from.ionosphere);
  from.kepler.clear();
  from.glonass.clear();
  from.ionosphere.clear();
}

void BroadcastMessages::limit(std::size_t most) {
  if (kepler.size() > most) kepler.clear();
  if (glonass.size() > most) glonass.clear();
  if (ionosphere.size() > most) ionosphere.clear();
}

bool plausible(const KeplerMessage& m) {
  return m.e >= 0.0 && m.e < 0.5 && m.sqrt_a >= 4000.0 && m.sqrt_a <= 8000.0 &&
         std::abs(m.af0) <= 1.0;
}

bool plausible(const GlonassMessage& m) {
  const double radius = m.position.norm();
  return radius >= 2.3e7 && radius <= 2.8e7 && m.velocity.norm() <= 5e3 &&
         std::abs(m.minus_tau) <= 1.0 && m.channel >= -7 && m.channel <= 13;
}

bool plausible(const IonosphereCoefficients& coefficients) {
  // These are the largest values of eight bits, and of Galileo's eleven and fourteen.
  static constexpr std::array<double, 8> max_klobuchar{0x1p-23, 0x1p-20, 0x1p-17, 0x1p-17,
                                                       0x1p18,  0x1p21,  0x1p23,  0x1p23};
  static constexpr std::array<double, 3> max_level{512.0, 4.0, 0.25};
  const auto within = [](const auto& values, const auto& most) {
    bool nonzero = false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(std::abs(values[i]) <= most[i])) return false;
      nonzero |= values[i] != 0.0;
    }
    return nonzero;
  };
  if (const auto* k = std::get_if<Klobuchar>(&coefficients))
    return within(k->values, max_klobuchar);
  return within(std::get<IonisationLevel>(coefficients).values, max_level);
}

void refuse(NavigationFile& navigation, const std::string& place, const std::string& why) {
  constexpr std::size_t max_reasons = 20;
  ++navigation.refused;
  if (navigation.refusals.size() < max_reasons) navigation.refusals.push_back(place + ": " + why);
}

void refuse(NavigationFile& navigation, std::size_t offset, const std::string& why) {
  refuse(navigation, navigation.file + ": byte " + std::to_string(offset), why);
}

}  // namespace maploop::ppp
