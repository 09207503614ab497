// Defines the interface of broadcast and precise ephemerides: positions of satellites and their
// clocks.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "ppp/gps_time.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// A SatelliteState holds at the moment of transmission, in the earth-fixed frame of that moment.
struct SatelliteState {
  Eigen::Vector3d position{0, 0, 0};  // m
  Eigen::Vector3d velocity{0, 0, 0};  // m/s
  double clock = 0.0;                 // s, including the relativity of an eccentric orbit
  double clock_drift = 0.0;           // s/s
  double sigma = 0.0;                 // m, of the range, from orbit and clock
  std::uint32_t source = 0;           // ranges change by more than the walk when this changes
  std::uint32_t phase_jumps = 0;      // the biases of its phases jump when this changes
  GpsTime message{};  // reference time of the broadcast message; ranges jump when it changes
};

class Ephemeris {
 public:
  virtual ~Ephemeris() = default;

  // `t` is the time of transmission in GPS time. Returns nothing if the state is unknown or the
  // satellite unhealthy; missing() then gives the reason.
  virtual std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const = 0;
  // Returns the clock alone, s, which is needed to find the time of transmission.
  virtual std::optional<double> clock(Satellite satellite, GpsTime t) const = 0;
  // Returns what must be subtracted from the code of a carrier to make it consistent with the
  // clock, m.
  virtual double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const = 0;
  // These biases may leave an error that vanishes in the ionosphere-free combination of the codes
  // of the system's two bands. Returns how much ionosphere it amounts to, m on GPS L1, or nothing
  // if it is unknown.
  virtual std::optional<double> ionosphere_bias(Satellite, GpsTime) const { return 0.0; }
  // Returns the same for the phase of a carrier, m. With the biases of two carriers their
  // ambiguities are integers, apart from what all satellites of a system have in common. Returns
  // nothing if it is unknown.
  virtual std::optional<double> phase_bias(Satellite, char, char, GpsTime) const { return {}; }
  // Returns the random walk of the errors of orbit and clock, which the ambiguity absorbs,
  // m/sqrt(s).
  virtual double error_walk(Satellite satellite) const = 0;
  // Returns whether positions are those of the centre of mass, so that phase centres must be added.
  virtual bool centre_of_mass() const = 0;
  // Returns the rotation from the satellite's body to the earth-fixed frame, if products contain
  // it.
  virtual std::optional<Eigen::Quaterniond> attitude(Satellite, GpsTime) const { return {}; }
  // Returns the frequency channel of a GLONASS satellite (0 to 99), if the messages contain it.
  virtual std::optional<int> glonass_channel(int) const { return {}; }
  // Returns a reason such as "no clocks for E12 after 2020-06-25 01:00:00.000".
  virtual std::string missing(Satellite satellite, GpsTime t) const = 0;
};

}  // namespace maploop::ppp
