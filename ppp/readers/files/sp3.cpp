#include "ppp/readers/files/sp3.h"

#include <algorithm>
#include <cmath>

#include "msgs/input_limits.h"

namespace maploop::ppp {
namespace {

Satellite satellite_in(const Lines& lines, std::size_t column) {
  const auto satellite = parse_satellite(lines.column(column, 3));
  if (!satellite)
    lines.fail("'" + std::string(lines.column(column, 3)) +
               "' is not a satellite; expected e.g. G05");
  return *satellite;
}

// Returns GPS time minus the time system that the first %c line names.
Duration offset_of(const Lines& lines, std::string_view name) {
  if (name == "UTC" || name == "GLO")
    lines.fail("SP3 in UTC is not supported; GPS, GAL, BDT, QZS, TAI are");
  if (name == "BDT") return std::chrono::seconds(14);
  if (name == "TAI") return -std::chrono::seconds(19);
  return Duration::zero();  // an SP3-a file contains "ccc", which means GPS
}

void read_point(const Lines& lines, OrbitFile& result) {
  const auto found = result.points.find(satellite_in(lines, 1));
  if (found == result.points.end()) {
    lines.fail(std::string(lines.column(1, 3)) + " is not in the header's list of satellites");
  }
  const Eigen::Vector3d p(lines.number(4, 14, "coordinate"), lines.number(18, 14, "coordinate"),
                          lines.number(32, 14, "coordinate"));
  const double clock = lines.number_or(46, 14, 999999.999999, "clock");
  auto& points = found->second;
  points.resize(result.epochs.size());
  OrbitFile::Point& point = points.back();
  const double radius = p.norm() * 1e3;
  if (radius > 0.0 && (radius < 6.4e6 || radius > 6e7)) {
    ++result.refused;
    return;
  }
  point.position = p * 1e3;
  point.has_clock = std::abs(clock) < 999999.0;
  if (point.has_clock) point.clock = clock * 1e-6;
}

}  // namespace

// Returns how many points a text of this size has at most, with room for epochs that lack many of
// them.
std::size_t points_in(std::string_view text) {
  // A position has 46 bytes, and at least one point in 8 is present.
  constexpr std::size_t line = 46, share = 8;
  return std::min(input_limits::orbit_points, share * (text.size() / line));
}

OrbitFile parse_sp3(std::string_view text, const std::string& file) {
  OrbitFile result;
  result.file = file;
  Lines lines(text, file);
  if (!lines.next() || lines.column(0, 1) != "#" || lines.line().size() < 55) {
    lines.fail("an SP3 file must start with #a, #b, #c or #d and a line of 60 columns");
  }
  const char version = lines.line()[1];
  if (version < 'a' || version > 'd') lines.fail("unknown version; SP3-a to SP3-d are supported");
  result.frame = std::string(trimmed(lines.column(46, 5)));
  result.agency = std::string(trimmed(lines.column(56, 4)));
  if (!lines.next() || lines.column(0, 2) != "##") lines.fail("the second line must start with ##");
  const double interval = lines.number(24, 14, "interval");
  if (!(interval > 0.0 && interval <= 86400.0))
    lines.fail("an interval must be above 0 s and at most one day");
  result.interval = from_seconds(interval);

  int listed = 0, count = -1;
  Duration to_gps{0};
  bool system_read = false, ended = false;
  while (lines.next()) {
    const auto line = lines.line();
    const auto start = columns(line, 0, 2);
    if (start == "+ ") {
      if (count < 0) {
        count = lines.integer(2, 4, "number of satellites");
        if (count < 1 || count > 999) lines.fail("the number of satellites must be 1 to 999");
      }
      for (std::size_t i = 0; i < 17 && listed < count; ++i, ++listed) {
        result.points[satellite_in(lines, 9 + 3 * i)];
      }
    } else if (start == "%c" && !system_read) {
      to_gps = offset_of(lines, lines.column(9, 3));
      system_read = true;
    } else if (start == "* ") {
      if (listed < count || count < 0) lines.fail("the header's list of satellites is incomplete");
      const GpsTime t = parse_stamp(lines, line.substr(1)) + to_gps;
      if (!result.epochs.empty() && t <= result.epochs.back()) {
        lines.fail("epoch " + format_gps_time(t) + " is not after the one before");
      }
      for (auto& [satellite, points] : result.points) points.resize(result.epochs.size());
      result.epochs.push_back(t);
      // A complete epoch has a line for each listed satellite.
      if (result.epochs.size() * result.points.size() > points_in(text)) {
        lines.fail("the file is too short for its epochs of " +
                   std::to_string(result.points.size()) + " satellites");
      }
    } else if (!line.empty() && line[0] == 'P') {
      if (result.epochs.empty()) lines.fail("a position precedes the first epoch");
      if (!lines.whole()) {
        ++result.refused;
        break;
      }
      read_point(lines, result);
    } else if (line.starts_with("EOF")) {
      ended = true;
      break;
    } else if (!line.empty() &&
               std::string_view("V+%/E#").find(line[0]) == std::string_view::npos) {
      lines.fail("unknown line in an SP3 file");
    }
  }
  if (result.epochs.empty()) lines.fail("the file contains no epochs");
  if (!ended) ++result.refused;
  for (auto& [satellite, points] : result.points) points.resize(result.epochs.size());
  return result;
}

}  // namespace maploop::ppp
