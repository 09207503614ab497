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
  // The fractional part of a satellite's wide lane, which CNES/CLS state in comments of the header;
  // with it, and with these clocks, ambiguities are integers (Laurichesse et al., "Integer
  // ambiguity resolution on undifferenced GPS phase measurements", Navigation 56, 2009).
  struct WideLane {
    Satellite satellite;
    GpsTime time{};  // the middle of its day
    double cycles = 0.0;
  };
  std::string file, agency;
  std::map<Satellite, std::vector<Point>> points;  // in the order of time
  std::vector<WideLane> wide_lanes;
  int refused = 0;  // invalid points, points out of order, and an incomplete last line
};

ClockFile parse_clock(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
