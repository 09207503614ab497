// Broadcast orbits and clocks with a stream's corrections of them (SSR), as long as these come.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ppp/products/broadcast.h"
#include "ppp/readers/ssr.h"

namespace maploop::ppp {

// RTCM 10403.3, section 3.5.12. A satellite is corrected where orbit and clock of one solution are
// there, are not too old, and the message that they correct is. Corrected clocks count from another
// moment than broadcast ones: where four satellites of a system are corrected, its others are not
// known, and else all of them are as they were broadcast.
class CorrectedEphemeris : public Ephemeris {
 public:
  // How much older than their interval corrections may be: clocks wander by centimetres a minute.
  static constexpr Duration longest_age = std::chrono::seconds(90);

  explicit CorrectedEphemeris(BroadcastEphemeris broadcast) : broadcast_(std::move(broadcast)) {}

  void add(const BroadcastMessages& messages) { broadcast_.add(messages); }
  void add(const SsrUpdate& update);
  // The epoch that is asked about from now on: which corrections are used does not change within.
  void begin(GpsTime t);

  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override;
  std::optional<double> clock(Satellite satellite, GpsTime t) const override;
  double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const override;
  double error_walk(Satellite satellite) const override;
  bool centre_of_mass() const override { return false; }
  std::optional<int> glonass_channel(int number) const override {
    return broadcast_.glonass_channel(number);
  }
  std::string missing(Satellite satellite, GpsTime t) const override;

  const BroadcastIonosphere& ionosphere() const { return broadcast_.ionosphere(); }
  bool corrected(Satellite satellite) const { return current(satellite).has_value(); }
  // Of the newest clock of any satellite; nothing where none ever came.
  std::optional<Duration> age() const;

 private:
  template <class Value>
  struct Part {
    Value value;
    GpsTime time{};
    Duration interval{};
    std::uint32_t solution = 0;
    int issue = 0;  // of the solution
    bool goes_with(const auto& other) const {
      return solution == other.solution && issue == other.issue;
    }
  };
  struct Corrections {
    // The newest two: an orbit is there before its clock.
    std::optional<Part<SsrOrbit>> orbit, orbit_before;
    std::optional<Part<SsrClock>> clock;
    std::optional<Part<double>> high_rate;
    double sigma = 0.05;  // m, where no message says it
    std::vector<SsrBias> biases;
  };
  struct Current {
    const Part<SsrOrbit>* orbit;
    const Corrections* all;
  };
  std::optional<Current> available(Satellite satellite) const;
  std::optional<Current> current(Satellite satellite) const;  // and its system's are used
  template <class Value>
  bool fresh(const std::optional<Part<Value>>& part) const;

  BroadcastEphemeris broadcast_;
  GpsTime now_{};
  std::array<bool, system_count> used_{};
  std::vector<Corrections> corrections_{satellite_slots};
  std::optional<GpsTime> newest_;
};

}  // namespace maploop::ppp
