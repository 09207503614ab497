// Gives the ionosphere's delay from what is known of it: maps and messages of its electrons, or the
// broadcast coefficients that apply to a given moment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ppp/models/ionosphere.h"
#include "ppp/readers/files/navigation.h"

namespace maploop::ppp {

// `age` is the time between the moment and the transmission of the coefficients; zero if they were
// being transmitted.
struct NearestIonosphere {
  IonosphereCoefficients coefficients;
  Duration age;
};

class BroadcastIonosphere {
 public:
  // Older coefficients do not match the season and the activity of the sun.
  static constexpr Duration longest_age = std::chrono::hours(24 * 60);

  // Repeated coefficients extend the period of the existing ones. Up to 64 sets are kept, the
  // latest ones.
  void add(const IonosphereMessage& message);

  // Returns the coefficients nearest to `t`, or nothing if there are none within longest_age.
  // Galileo's are preferred if they are at most a day away, or as near as those of GPS.
  std::optional<NearestIonosphere> at(GpsTime t) const;
  std::optional<Duration> age(GpsTime t) const;

  // Saves the coefficients; loading adds them to those that are there.
  template <class Archive>
  void archive(Archive& ar) {
    std::vector<IonosphereMessage> saved;
    if constexpr (Archive::loading) {
      ar(saved);
      for (const IonosphereMessage& message : saved) add(message);
    } else {
      ar(messages_);
    }
  }

 private:
  std::vector<IonosphereMessage> messages_;
};

// This is the vertical content above a place and its standard deviation, TECU.
struct VerticalElectrons {
  double value = 0.0, sigma = 0.0;
  std::uint64_t source = 0;  // the value may jump where this changes
};

// Knows the electrons of a region and a period.
class ElectronContent {
 public:
  virtual ~ElectronContent() = default;
  // Returns whether they are known at a moment, at least somewhere.
  virtual bool covers(GpsTime t) const = 0;
  // Returns nothing where they are unknown.
  virtual std::optional<VerticalElectrons> at(const PiercePoint& place, GpsTime t) const = 0;
};

// This is a model's delay towards a satellite and its standard deviation, m on GPS L1.
struct IonosphericDelay {
  double value = 0.0, sigma = 0.0;
  std::uint64_t source = 0;  // the value may jump where this changes
};

IonosphericDelay ionospheric_delay(const VerticalElectrons& electrons, double elevation);

// Without coefficients, returns the delay of a usual level of ionisation. `azimuth` and `elevation`
// are in rad.
IonosphericDelay ionospheric_delay(const std::optional<NearestIonosphere>& coefficients,
                                   const Geodetic& site, double azimuth, double elevation,
                                   GpsTime t);

// Returns a sentence stating that there are no coefficients, or that they are from another day;
// empty if they are at most a day and a half away.
std::string ionosphere_lack(std::optional<Duration> age);

}  // namespace maploop::ppp
