// Reads precise orbits from SP3-a to SP3-d.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// Positions are those of the centre of mass (or of the antenna, if the agency states so), ITRF, m.
struct OrbitFile {
  struct Point {
    Eigen::Vector3d position{0, 0, 0};  // zero: unknown
    double clock = 0.0;                 // s; meaningless if has_clock is false
    bool has_clock = false;
  };
  std::string file, agency, frame;
  Duration interval{0};
  std::vector<GpsTime> epochs;
  std::map<Satellite, std::vector<Point>> points;  // one per epoch
  int refused = 0;                                 // invalid points, and an incomplete last epoch
};

OrbitFile parse_sp3(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
