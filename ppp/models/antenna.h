// Computes by how much a measured range exceeds that to an antenna's reference point, m.
#pragma once

#include <array>
#include <vector>

#include "ppp/readers/files/antex.h"

namespace maploop::ppp {

// `zenith` is the zenith angle (for a satellite the nadir angle) and `azimuth` the azimuth angle,
// rad. A zenith angle beyond the grid takes the value of its edge.
double phase_variation(const Antenna& antenna, const PhaseCentre& carrier, double zenith,
                       double azimuth);

// Returns the excess for a receiver's antenna, relative to its reference point; `to_satellite_enu`
// is a unit vector. For a carrier that was not calibrated, the closer one of GPS's two carriers is
// used; 0 if that one is missing too.
double receiver_phase_centre(const Antenna& antenna, System system, char band,
                             const Eigen::Vector3d& to_satellite_enu);

// Returns the excess for a satellite's antenna, relative to its centre of mass. The columns of
// `R_ecef_body` are the axes of the satellite's body, and `to_receiver` is a unit vector
// (earth-fixed). For a carrier that was not calibrated, the antenna's first carrier is used; 0 if
// it has none.
double satellite_phase_centre(const Antenna& antenna, System system, char band,
                              const Eigen::Matrix3d& R_ecef_body,
                              const Eigen::Vector3d& to_receiver);

// A satellite whose antenna is not known is given the mean height of its system's phase centres.
struct AssumedAntenna {
  Antenna antenna;     // no carriers: none of the system is known
  double sigma = 0.0;  // m, standard deviation of the heights
};

// The antennas of all satellites at a time. The files must outlive this.
//
// Of several calibrations of a satellite that have begun, one of a file of satellites only counts,
// and of these the one that began last, because an old file does not know that another satellite
// has taken the number.
class SatelliteAntennas {
 public:
  SatelliteAntennas(const std::vector<AntennaFile>& files, GpsTime t);

  // Returns nullptr if no file contains the satellite's antenna, or if its calibration has ended.
  const Antenna* of(Satellite satellite) const { return own_[satellite.slot()]; }
  const AssumedAntenna& assumed(System system) const {
    return assumed_[static_cast<std::size_t>(system)];
  }

 private:
  std::vector<const Antenna*> own_;  // by Satellite::slot()
  std::array<AssumedAntenna, system_count> assumed_;
};

// Returns the antenna of a type with its radome, or with radome NONE if that combination was not
// calibrated; nullptr if no file contains either.
const Antenna* receiver_antenna(const std::vector<AntennaFile>& files, const std::string& type,
                                const std::string& radome);

}  // namespace maploop::ppp
