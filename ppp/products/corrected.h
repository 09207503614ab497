// Applies a stream's corrections (SSR) to broadcast orbits and clocks, for as long as they arrive.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ppp/products/broadcast.h"
#include "ppp/products/ssr_electrons.h"
#include "ppp/readers/corrections/ssr.h"

namespace maploop::ppp {

// A part of a satellite's corrections, and the message that brought it.
template <class Value>
struct SsrPart {
  Value value;
  GpsTime time{};
  Duration interval{};
  std::uint32_t solution = 0;
  int issue = 0;  // issue of the solution
  bool same_solution(const auto& other) const {
    return solution == other.solution && issue == other.issue;
  }
};

// The corrections are those of RTCM 10403.3, section 3.5.12. A satellite is corrected if orbit and
// clock of one solution are available and recent, and so is the broadcast message that they refer
// to. Corrected clocks count from another origin than broadcast ones: if at least four satellites
// of a system are corrected, its other satellites are not used; otherwise none of its satellites is
// corrected.
class CorrectedEphemeris : public Ephemeris {
 public:
  // This is how long corrections stay in use after their interval: clocks wander by centimetres per
  // minute.
  static constexpr Duration longest_age = std::chrono::seconds(90);

  explicit CorrectedEphemeris(BroadcastEphemeris broadcast) : broadcast_(std::move(broadcast)) {}

  void add(const BroadcastMessages& messages) { broadcast_.add(messages); }
  void add(const SsrUpdate& update);
  void add(SsrIonosphere ionosphere) { electrons_.set(std::move(ionosphere)); }
  // Sets the epoch of the following calls, which decides for all of them which corrections are
  // used.
  void begin(GpsTime t);

  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override;
  std::optional<double> clock(Satellite satellite, GpsTime t) const override;
  double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const override;
  std::optional<double> phase_bias(Satellite satellite, char band, char attribute,
                                   GpsTime t) const override;
  double error_walk(Satellite satellite) const override;
  bool centre_of_mass() const override { return false; }
  std::optional<int> glonass_channel(int number) const override {
    return broadcast_.glonass_channel(number);
  }
  std::string missing(Satellite satellite, GpsTime t) const override;

  const BroadcastIonosphere& ionosphere() const { return broadcast_.ionosphere(); }
  const ElectronContent& electrons() const { return electrons_; }
  bool corrected(Satellite satellite) const { return current(satellite).has_value(); }
  // Returns the age of the newest clock correction of any satellite; nothing if none ever came.
  std::optional<Duration> age() const;

  // Saves the broadcast messages, and loads them as BroadcastEphemeris does: corrections are soon
  // sent again.
  void archive(auto& ar) { ar(broadcast_); }
  static constexpr std::size_t usual_archive = 3 * 2 * usual_satellites * sizeof(KeplerMessage);

 private:
  struct Corrections {
    // These are the newest two, because an orbit arrives before its clock.
    std::optional<SsrPart<SsrOrbit>> orbit, orbit_before;
    std::optional<SsrPart<SsrClock>> clock;
    std::optional<SsrPart<double>> high_rate;
    double sigma = 0.05;  // m, if no message gives it
    std::vector<SsrBias> biases;
    std::vector<SsrPhaseBias> phase_biases;
  };
  struct Current {
    const SsrPart<SsrOrbit>* orbit;
    const Corrections* all;
  };
  std::optional<Current> available(Satellite satellite) const;
  std::optional<Current> current(Satellite satellite) const;  // if its system is corrected
  template <class Value>
  bool fresh(const std::optional<SsrPart<Value>>& part) const;

  BroadcastEphemeris broadcast_;
  SsrElectrons electrons_;
  GpsTime now_{};
  std::array<bool, system_count> used_{};
  std::vector<Corrections> corrections_{satellite_slots};
  std::optional<GpsTime> newest_;
};

}  // namespace maploop::ppp
