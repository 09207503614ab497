// Phase centres: by how much a measured range is longer than that to the reference point; m.
#pragma once

#include "ppp/readers/antex.h"

namespace maploop::ppp {

// At zenith (of a satellite: nadir) and azimuth angle, rad. Angles beyond the grid take its edge.
double phase_variation(const Antenna& antenna, const PhaseCentre& carrier, double zenith,
                       double azimuth);

// A receiver's antenna, from the reference point; `to_satellite_enu` is a unit vector. A carrier
// that was not calibrated takes that of the nearest of GPS's two.
double receiver_phase_centre(const Antenna& antenna, System system, char band,
                             const Eigen::Vector3d& to_satellite_enu);

// A satellite's antenna, from its centre of mass; columns of `R_ecef_body` are the body's axes and
// `to_receiver` a unit vector. Only where the carrier (or the system's first) is calibrated, else
// 0.
double satellite_phase_centre(const Antenna& antenna, System system, char band,
                              const Eigen::Matrix3d& R_ecef_body,
                              const Eigen::Vector3d& to_receiver);

// The antenna of a satellite at a time; nothing where no file has it.
const Antenna* satellite_antenna(const std::vector<AntennaFile>& files, Satellite satellite,
                                 GpsTime t);
// Of a type with its radome; without the radome's calibration that of NONE.
const Antenna* receiver_antenna(const std::vector<AntennaFile>& files, const std::string& type,
                                const std::string& radome);

}  // namespace maploop::ppp
