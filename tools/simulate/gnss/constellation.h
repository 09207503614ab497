// The satellites that are there: orbits and clocks without error, from which broadcast and precise
// products are made with theirs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/satellite.h"

namespace maploop::simulate {

// An orbit as IS-GPS-200 describes one, about time 0; m, rad, s. Its periodic terms are of the size
// that the earth's flattening gives real ones.
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

// Where a carrier leaves the satellite, along its axis to the earth.
struct TransmitAntenna {
  double phase_centre = 0.0;           // m from the centre of mass
  std::array<double, 15> variation{};  // m, at 0 to 14 degrees from the axis
};

struct TrueSatellite {
  ppp::Satellite satellite;
  OrbitElements orbit;                           // of the centre of mass
  double clock_offset = 0.0, clock_drift = 0.0;  // s, s/s at time 0
  double group_delay = 0.0;                      // s, of the first carrier; the second's follows
  std::array<TransmitAntenna, 2> antennas;       // of both carriers
};

// GPS, 30 satellites in six planes, and Galileo, 24 in three. Times are seconds since the drive's
// start, of GPS time.
class Constellation {
 public:
  // Clocks wander from `margin` seconds before the drive to `margin` after it.
  Constellation(double seconds, std::uint64_t seed);

  static constexpr double margin = 600.0;

  const std::vector<TrueSatellite>& satellites() const { return satellites_; }
  // s, ahead of GPS time; without the relativity of an eccentric orbit.
  double clock(std::size_t satellite, double t) const;

 private:
  std::vector<TrueSatellite> satellites_;
  std::vector<std::vector<double>> walks_;  // s, of each clock each second
};

// s, what a clock shows less for its orbit's eccentricity: -2 r.v / c^2.
double clock_relativity(const OrbitElements& orbit, double t);

// The two carriers that are simulated of each system.
std::array<char, 2> bands(ppp::System system);

}  // namespace maploop::simulate
