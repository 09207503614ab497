// The simulated satellites: their orbits and clocks have no error; broadcast and precise products
// are made from them with errors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/satellite.h"

namespace maploop::simulate {

// An orbit as IS-GPS-200 describes one, relative to time 0; m, rad, s. Its periodic terms are about
// as large as those that the earth's flattening causes in real orbits.
struct OrbitElements {
  double semi_major_axis = 0.0, eccentricity = 0.0, inclination = 0.0;
  double node = 0.0;  // longitude of the ascending node at time 0, earth-fixed
  double perigee = 0.0, mean_anomaly = 0.0;
  double node_rate = 0.0, inclination_rate = 0.0;
  double crs = 0.0, crc = 0.0, cus = 0.0, cuc = 0.0, cis = 0.0, cic = 0.0;

  double mean_motion() const;                // rad/s
  Eigen::Vector3d position(double t) const;  // m, in the earth-fixed frame of that moment
  Eigen::Vector3d velocity(double t) const;  // m/s, in that frame
};

// The phase centre of a carrier, along the satellite's axis towards the earth.
struct TransmitAntenna {
  double phase_centre = 0.0;           // m from the centre of mass
  std::array<double, 15> variation{};  // m, at 0 to 14 degrees from the axis
};

struct TrueSatellite {
  ppp::Satellite satellite;
  OrbitElements orbit;                           // of the centre of mass
  double clock_offset = 0.0, clock_drift = 0.0;  // s and s/s, at time 0
  double group_delay = 0.0;  // s, of the first carrier; the second carrier's is derived from it
  std::array<TransmitAntenna, 2> antennas;  // one for each carrier
};

// GPS has 30 satellites in six planes, Galileo 24 in three. Times are seconds of GPS time since the
// drive's start.
class Constellation {
 public:
  // Clocks wander from `margin` seconds before the drive until `margin` seconds after it.
  Constellation(double seconds, std::uint64_t seed);

  static constexpr double margin = 600.0;

  const std::vector<TrueSatellite>& satellites() const { return satellites_; }
  // Returns the offset from GPS time in s, without the relativistic effect of an eccentric orbit.
  double clock(std::size_t satellite, double t) const;

 private:
  std::vector<TrueSatellite> satellites_;
  std::vector<std::vector<double>> walks_;  // s, of each clock, one value each second
};

// Returns the relativistic clock correction of an eccentric orbit in s: -2 r.v / c^2.
double clock_relativity(const OrbitElements& orbit, double t);

// Returns the two carriers that are simulated for each system.
std::array<char, 2> bands(ppp::System system);

}  // namespace maploop::simulate
