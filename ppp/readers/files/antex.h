// Reads antenna calibrations from ANTEX 1.2 to 1.4.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// A PhaseCentre describes the phase centre of one carrier.
struct PhaseCentre {
  System system = System::gps;
  char band = '1';
  // The offset of a receiver's antenna is north, east, up; that of a satellite's is along its
  // body's x, y, z. m.
  Eigen::Vector3d offset{0, 0, 0};
  std::vector<double> no_azimuth;             // m, by zenith (nadir) angle
  std::vector<std::vector<double>> azimuths;  // m, by azimuth step, then zenith angle; may be empty
};

struct Antenna {
  std::string type, serial;  // type with its radome, up to 20 columns, without trailing blanks
  std::optional<Satellite> satellite;  // set for a satellite's antenna
  GpsTime valid_from{GpsTime::min()}, valid_until{GpsTime::max()};
  double zenith_first = 0, zenith_last = 0, zenith_step = 5;  // degrees
  double azimuth_step = 0;                                    // degrees; 0: no rows by azimuth
  std::vector<PhaseCentre> carriers;

  const PhaseCentre* carrier(System system, char band) const;
};

struct AntennaFile {
  std::string file;
  bool absolute = true;
  bool satellites_only = false;  // it contains no receiver's antenna
  std::vector<Antenna> antennas;
  int refused = 0;  // antennas without END OF ANTENNA
};

AntennaFile parse_antex(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
