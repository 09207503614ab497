// Where satellites are, and what their clocks say: broadcast and precise behind one interface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "ppp/gps_time.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// At the moment of transmission, in the earth-fixed frame of that moment.
struct SatelliteState {
  Eigen::Vector3d position{0, 0, 0};  // m
  Eigen::Vector3d velocity{0, 0, 0};  // m/s
  double clock = 0.0;                 // s, with the relativity of an eccentric orbit
  double clock_drift = 0.0;           // s/s
  double sigma = 0.0;                 // m, of range from orbit and clock
  std::uint32_t source = 0;           // ranges by another one differ by more than they walk
  GpsTime message{};                  // reference time of the broadcast one; by another they jump
};

class Ephemeris {
 public:
  virtual ~Ephemeris() = default;

  // `t` is the transmission in GPS time. Nothing: not known, or unhealthy; missing() says why.
  virtual std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const = 0;
  // The clock alone, for finding the time of transmission; s.
  virtual std::optional<double> clock(Satellite satellite, GpsTime t) const = 0;
  // What to subtract from the code of a carrier so that it fits the clock; m.
  virtual double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const = 0;
  // How errors of an orbit and clock change, which the ambiguity takes up; m/sqrt(s).
  virtual double error_walk(Satellite satellite) const = 0;
  // Whether positions are the centre of mass, which phase centres are still to be added to.
  virtual bool centre_of_mass() const = 0;
  // Of a satellite of GLONASS, 0 to 99, where the message says it.
  virtual std::optional<int> glonass_channel(int) const { return {}; }
  // "no clock for E12 at 2020-06-25 01:00:00.000".
  virtual std::string missing(Satellite satellite, GpsTime t) const = 0;
};

}  // namespace maploop::ppp
