#include "ppp/readers/files/ocean_loading.h"

#include <cmath>
#include <numbers>

namespace maploop::ppp {
namespace {

// Reads "$$ ONSA                     RADI TANG lon/lat:   11.9264   57.3958".
void read_comment(const Lines& lines, OceanLoading& station) {
  const auto line = lines.line();
  auto at = line.find("lon/lat:");
  if (at == std::string_view::npos) return;
  at += 8;
  double values[2];
  for (double& value : values) {
    at = std::min(line.find_first_not_of(' ', at), line.size());
    const auto end = std::min(line.find(' ', at), line.size());
    const auto number = parse_number(line.substr(at, end - at));
    if (!number) return;
    value = *number;
    at = end;
  }
  station.longitude = values[0];
  station.latitude = values[1];
}

void read_row(const Lines& lines, double unit, std::array<double, 11>& row) {
  const auto line = lines.line();
  std::size_t at = 0;
  for (double& value : row) {
    at = line.find_first_not_of(' ', at);
    if (at == std::string_view::npos) lines.fail("a row must have 11 constituents");
    const auto end = std::min(line.find(' ', at), line.size());
    const auto number = parse_number(line.substr(at, end - at));
    if (!number) lines.fail("'" + std::string(line.substr(at, end - at)) + "' is not a number");
    if (std::abs(*number) > 360.0)
      lines.fail("an amplitude in m or a phase in degrees must be within 360");
    value = *number * unit;
    at = end;
  }
}

bool comment(const Lines& lines) {
  return lines.line().starts_with("$$") || blank(lines.line());
}

}  // namespace

OceanLoadingFile parse_blq(std::string_view text, const std::string& file) {
  OceanLoadingFile result;
  result.file = file;
  Lines lines(text, file);
  while (lines.next()) {
    if (comment(lines)) continue;
    OceanLoading station;
    station.station = std::string(trimmed(lines.line()));
    if (station.station.size() > 40) lines.fail("the name of a station has at most 40 characters");
    for (std::size_t row = 0; row < 6; ++row) {
      do {
        if (!lines.next()) lines.fail("the file ends inside a station");
        if (comment(lines)) read_comment(lines, station);
      } while (comment(lines));
      read_row(lines, row < 3 ? 1.0 : std::numbers::pi / 180.0,
               row < 3 ? station.amplitude[row] : station.phase[row - 3]);
    }
    result.stations.push_back(station);
  }
  if (result.stations.empty()) lines.fail("the file contains no station");
  return result;
}

}  // namespace maploop::ppp
