#include "ppp/readers/files/clock.h"

#include <cmath>

namespace maploop::ppp {
namespace {

// Reads "WL G01  2020  6 25 12  0  0.000000  1   -0.110300E+01  0102 COMMENT". Other comments are
// no wide lanes.
void read_wide_lane(const Lines& lines, ClockFile& result) {
  if (lines.column(0, 3) != "WL ") return;
  const auto satellite = parse_satellite(lines.column(3, 3));
  if (!satellite) return;
  const double cycles = lines.number(39, 16, "wide lane");
  if (std::abs(cycles) > 100.0) lines.fail("a wide lane's bias must be within 100 cycles");
  result.wide_lanes.push_back({*satellite, parse_stamp(lines, lines.column(8, 26)), cycles});
}

}  // namespace

ClockFile parse_clock(std::string_view text, const std::string& file) {
  ClockFile result;
  result.file = file;
  Lines lines(text, file);
  if (!lines.next() || lines.line().find("RINEX VERSION / TYPE") == std::string_view::npos) {
    lines.fail("a RINEX file starts with RINEX VERSION / TYPE");
  }
  const double version = lines.number(0, 9, "version");
  if (version < 2.0 || version >= 3.05)
    lines.fail("unknown version; RINEX clock 2.00 to 3.04 is supported");
  if (lines.line().find('C', 20) == std::string_view::npos)
    lines.fail("not a clock file: the file type must be C");
  // Version 3.04 has longer station names, and every column after them is 5 further right.
  const std::size_t shift = version >= 3.04 ? 5 : 0;
  for (bool header = true; header;) {
    if (!lines.next()) lines.fail("the file ends inside its header");
    const auto line = lines.line();
    header = line.find("END OF HEADER", 60) == std::string_view::npos;
    if (line.find("ANALYSIS CENTER", 60) != std::string_view::npos) {
      result.agency = std::string(trimmed(lines.column(0, 3)));
    }
    if (line.find("COMMENT", 60) != std::string_view::npos) read_wide_lane(lines, result);
    const auto at = line.find("TIME SYSTEM ID", 60);
    if (at != std::string_view::npos && trimmed(lines.column(0, 9)) != "GPS") {
      lines.fail("clocks in a time system other than GPS are not supported");
    }
  }
  std::string_view stamp_text;
  GpsTime stamp{};
  while (lines.next()) {
    if (lines.column(0, 3) != "AS ") continue;
    if (!lines.whole()) {
      ++result.refused;
      break;
    }
    const auto satellite = parse_satellite(lines.column(3, 3));
    if (!satellite)
      lines.fail("'" + std::string(lines.column(3, 3)) + "' is not a satellite; expected e.g. G05");
    // The stamp is repeated for each satellite.
    const auto columns_of_stamp = lines.column(8 + shift, 26);
    if (columns_of_stamp != stamp_text) {
      stamp = parse_stamp(lines, columns_of_stamp);
      stamp_text = columns_of_stamp;
    }
    const double offset = lines.number(40 + shift, 19, "clock offset");
    auto& points = result.points[*satellite];
    if (std::abs(offset) > 1.0 || (!points.empty() && points.back().time >= stamp)) {
      ++result.refused;
    } else {
      points.push_back({stamp, offset});
    }
    const int values = lines.integer(34 + shift, 3, "number of values");
    if (values > 2 && !lines.next()) ++result.refused;
  }
  if (result.points.empty()) lines.fail("the file contains no satellite clock");
  return result;
}

}  // namespace maploop::ppp
