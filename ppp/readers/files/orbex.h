// Reads the attitudes of satellites from ORBEX files (Loyer et al., "ORBEX: The Orbit Exchange
// Format", 0.09, IGS 2019).
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

struct AttitudeFile {
  struct Point {
    GpsTime time{};
    Eigen::Quaterniond R_ecef_body{1.0, 0.0, 0.0, 0.0};  // unit length
  };
  std::string file;
  std::map<Satellite, std::vector<Point>> points;  // in the order of time
  int refused = 0;                                 // records that are no rotation
};

// Throws ReadError for what is not ORBEX, is damaged, or is in other frames or times than the
// earth-fixed frame and GPS time.
AttitudeFile parse_orbex(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
