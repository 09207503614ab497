// What satellites have said of the ionosphere, and which of it is for a moment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ppp/models/ionosphere.h"
#include "ppp/readers/navigation.h"

namespace maploop::ppp {

// Coefficients, and how far from the moment they were sent; zero: then.
struct NearestIonosphere {
  IonosphereCoefficients coefficients;
  Duration age;
};

class BroadcastIonosphere {
 public:
  // Farther from the moment they say nothing of its season and of the sun's activity.
  static constexpr Duration longest_age = std::chrono::hours(24 * 60);

  // The same coefficients again are still those; of others the latest ones are kept.
  void add(const IonosphereMessage& message);

  // The nearest to `t`: Galileo's where they are of the day, or as near as those of GPS; nothing:
  // there are none, or they are older than longest_age.
  std::optional<NearestIonosphere> at(GpsTime t) const;
  std::optional<Duration> age(GpsTime t) const;

 private:
  std::vector<IonosphereMessage> messages_;
};

// A model's delay towards a satellite and its standard deviation; m on GPS L1.
struct IonosphericDelay {
  double value = 0.0, sigma = 0.0;
};

// Without coefficients: no delay, and the deviation that this leaves.
IonosphericDelay ionospheric_delay(const std::optional<NearestIonosphere>& coefficients,
                                   const Geodetic& site, double azimuth, double elevation,
                                   GpsTime t);

// As a sentence: that there are no coefficients, or that they are of another day. Empty: they are
// the day's.
std::string ionosphere_lack(std::optional<Duration> age);

}  // namespace maploop::ppp
