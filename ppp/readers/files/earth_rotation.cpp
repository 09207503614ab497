#include "ppp/readers/files/earth_rotation.h"

#include <cmath>
#include <numbers>

namespace maploop::ppp {

EarthRotationFile parse_erp(std::string_view text, const std::string& file) {
  constexpr double microarcsecond = std::numbers::pi / 180.0 / 3600.0 * 1e-6;
  EarthRotationFile result;
  result.file = file;
  Lines lines(text, file);
  if (!lines.next() || trimmed(lines.line()).substr(0, 9) != "VERSION 2") {
    std::string start(trimmed(lines.line()));
    if (start.substr(0, 9) != "version 2") lines.fail("an ERP file must start with VERSION 2");
  }
  bool table = false;
  while (lines.next()) {
    const auto line = trimmed(lines.line());
    if (line.starts_with("MJD")) {
      table = true;
      continue;
    }
    // The heading is followed by a line of units.
    if (!table || line.empty() || line.find_first_not_of("0123456789.-+ \t") != line.npos) continue;
    double values[5] = {};
    std::size_t at = 0;
    for (double& value : values) {
      at = line.find_first_not_of(" \t", at);
      if (at == line.npos) lines.fail("a row must have at least MJD, X, Y, UT1-UTC and LOD");
      const auto end = std::min(line.find_first_of(" \t", at), line.size());
      const auto number = parse_number(line.substr(at, end - at));
      if (!number) lines.fail("'" + std::string(line.substr(at, end - at)) + "' is not a number");
      value = *number;
      at = end;
    }
    const EarthRotation day{values[0], values[1] * microarcsecond, values[2] * microarcsecond,
                            values[3] * 1e-7, values[4] * 1e-7};
    if (day.mjd < 44000 || day.mjd > 125000 || std::abs(values[1]) > 2e6 ||
        std::abs(values[2]) > 2e6 || std::abs(day.ut1_minus_utc) > 40.0) {
      lines.fail("not earth rotation parameters in 1e-6 arcseconds and 1e-7 s");
    }
    if (!result.days.empty() && day.mjd <= result.days.back().mjd) {
      lines.fail("a day is not after the one before");
    }
    result.days.push_back(day);
  }
  if (result.days.empty()) lines.fail("the file contains no days");
  return result;
}

}  // namespace maploop::ppp
