// Precise orbits: SP3-a, -c and -d.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "ppp/readers/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// Positions of the centre of mass (of the antenna, where the agency says so), ITRF, m.
struct OrbitFile {
  struct Point {
    Eigen::Vector3d position{0, 0, 0};  // zero: not known
    double clock = 0.0;                 // s; of no use where has_clock is false
    bool has_clock = false;
  };
  std::string file, agency, frame;
  Duration interval{0};
  std::vector<GpsTime> epochs;
  std::map<Satellite, std::vector<Point>> points;  // as many as epochs
  int refused = 0;                                 // points that cannot be, and a cut last epoch
};

OrbitFile parse_sp3(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
