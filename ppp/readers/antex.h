// Antenna calibrations: ANTEX 1.3 and 1.4.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ppp/readers/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// Phase centre of one carrier.
struct PhaseCentre {
  System system = System::gps;
  char band = '1';
  // m. Receiver: north, east, up. Satellite: along the body's x, y, z.
  Eigen::Vector3d offset{0, 0, 0};
  std::vector<double> no_azimuth;             // m, by zenith (nadir) angle
  std::vector<std::vector<double>> azimuths;  // m, by azimuth step, then zenith angle; may be empty
};

struct Antenna {
  std::string type, serial;            // type with its radome, 20 columns without trailing blanks
  std::optional<Satellite> satellite;  // of a satellite's antenna
  GpsTime valid_from{GpsTime::min()}, valid_until{GpsTime::max()};
  double zenith_first = 0, zenith_last = 0, zenith_step = 5;  // degrees
  double azimuth_step = 0;                                    // degrees; 0: none
  std::vector<PhaseCentre> carriers;

  const PhaseCentre* carrier(System system, char band) const;
};

struct AntennaFile {
  std::string file;
  bool absolute = true;
  std::vector<Antenna> antennas;
  int refused = 0;  // without their END OF ANTENNA
};

AntennaFile parse_antex(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
