// Reads precise clocks from RINEX clock files 2.00 to 3.04, satellites only.
#pragma once

#include <map>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

struct ClockFile {
  struct Point {
    GpsTime time{};
    double offset = 0.0;  // s
  };
  std::string file, agency;
  std::map<Satellite, std::vector<Point>> points;  // in the order of time
  int refused = 0;  // invalid points, points out of order, and an incomplete last line
};

ClockFile parse_clock(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
