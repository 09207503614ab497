// Broadcast messages (IS-GPS-200, Galileo OS-SIS-ICD, BeiDou B1I and GLONASS ICDs).
#pragma once

#include <array>
#include <vector>

#include "ppp/products/ephemeris.h"
#include "ppp/readers/navigation.h"

namespace maploop::ppp {

class BroadcastEphemeris : public Ephemeris {
 public:
  explicit BroadcastEphemeris(const std::vector<NavigationFile>& files);

  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override;
  std::optional<double> clock(Satellite satellite, GpsTime t) const override;
  double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const override;
  double error_walk(Satellite) const override { return 3e-3; }
  bool centre_of_mass() const override { return false; }
  std::string missing(Satellite satellite, GpsTime t) const override;

  // Klobuchar's eight, of the first file that has them.
  const std::optional<std::array<double, 8>>& klobuchar() const { return klobuchar_; }
  std::array<std::optional<int>, 100> glonass_channels() const;

 private:
  const KeplerMessage* kepler(Satellite satellite, GpsTime t) const;
  const GlonassMessage* glonass(Satellite satellite, GpsTime t) const;

  // By slot; of each the messages in the order of toe.
  std::array<std::vector<KeplerMessage>, satellite_slots> kepler_;
  std::array<std::vector<GlonassMessage>, 100> glonass_;
  std::optional<std::array<double, 8>> klobuchar_;
};

}  // namespace maploop::ppp
