#include "ppp/products/ionosphere.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace maploop::ppp {
namespace {

constexpr Duration one_day = std::chrono::hours(24);

// Returns a number that differs between different coefficients; never 0.
std::uint64_t source_of(const IonosphereCoefficients& coefficients) {
  std::uint64_t source = coefficients.index();
  std::visit(
      [&source](const auto& c) {
        for (const double value : c.values)
          source = std::rotl(source, 7) ^ std::bit_cast<std::uint64_t>(value);
      },
      coefficients);
  return source | 1U;
}

Duration distance(const IonosphereMessage& m, GpsTime t) {
  return std::max({Duration::zero(), m.first - t, t - m.last});
}

}  // namespace

void BroadcastIonosphere::add(const IonosphereMessage& message) {
  constexpr std::size_t most = 64;
  for (IonosphereMessage& m : messages_) {
    if (m.coefficients != message.coefficients) continue;
    m.first = std::min(m.first, message.first);
    m.last = std::max(m.last, message.last);
    return;
  }
  messages_.push_back(message);
  if (messages_.size() <= most) return;
  messages_.erase(std::min_element(messages_.begin(), messages_.end(),
                                   [](const auto& a, const auto& b) { return a.last < b.last; }));
}

std::optional<NearestIonosphere> BroadcastIonosphere::at(GpsTime t) const {
  const auto nearest = [&](bool galileo) {
    const IonosphereMessage* best = nullptr;
    for (const IonosphereMessage& m : messages_) {
      if (std::holds_alternative<IonisationLevel>(m.coefficients) != galileo) continue;
      const auto nearer = std::pair(-distance(m, t), m.first);
      if (!best || nearer > std::pair(-distance(*best, t), best->first)) best = &m;
    }
    if (!best || distance(*best, t) > longest_age) return std::optional<NearestIonosphere>{};
    return std::optional(NearestIonosphere{best->coefficients, distance(*best, t)});
  };
  const auto galileo = nearest(true), gps = nearest(false);
  return galileo && (!gps || galileo->age <= std::max(gps->age, one_day)) ? galileo : gps;
}

std::optional<Duration> BroadcastIonosphere::age(GpsTime t) const {
  const auto nearest = at(t);
  return nearest ? std::optional(nearest->age) : std::nullopt;
}

IonosphericDelay ionospheric_delay(const std::optional<NearestIonosphere>& coefficients,
                                   const Geodetic& site, double azimuth, double elevation,
                                   GpsTime t) {
  if (!coefficients) {
    // Galileo's receivers take this level where they have none ("Ionospheric Correction Algorithm
    // for Galileo Single Frequency Users", European Commission, 1.2, 2016). The sun's activity
    // makes 0.7 to 2.2 times the delay of it.
    constexpr IonisationLevel usual{{63.7, 0.0, 0.0}};
    constexpr double share = 0.7;
    const double delay = ionospheric_delay(usual, site, azimuth, elevation, t);
    return {delay, share * delay};
  }
  // GPS chooses its coefficients for an error (root mean square) of half the delay, and changes
  // them every ten days.
  constexpr double share = 0.5;
  constexpr double days_to_change = 30.0;
  const double days = to_seconds(coefficients->age) / to_seconds(one_day);
  const double delay = ionospheric_delay(coefficients->coefficients, site, azimuth, elevation, t);
  return {delay, share * std::hypot(1.0, days / days_to_change) * delay,  // (3) of METHOD.md
          source_of(coefficients->coefficients)};
}

IonosphericDelay ionospheric_delay(const VerticalElectrons& electrons, double elevation) {
  const double factor = delay_of_electrons * ionospheric_slant(elevation);
  return {factor * electrons.value, factor * electrons.sigma, electrons.source};
}

std::string ionosphere_lack(std::optional<Duration> age) {
  if (!age) {
    return "no ionospheric coefficients for these days: one frequency is used with a usual level "
           "of the ionosphere; add IONEX maps, or a navigation file of that day or of a day close "
           "to it";
  }
  const auto days = std::lround(to_seconds(*age) / to_seconds(one_day));
  if (days < 2) return {};
  return "the ionospheric coefficients are of a day that is " + std::to_string(days) +
         " days away; add IONEX maps or a navigation file of the same day";
}

}  // namespace maploop::ppp
