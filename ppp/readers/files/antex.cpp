#include "ppp/readers/files/antex.h"

#include <algorithm>
#include <cmath>

namespace maploop::ppp {
namespace {

std::string_view label(const Lines& lines) {
  return trimmed(lines.column(60, 20));
}

void advance(Lines& lines) {
  if (!lines.next()) lines.fail("the file ends inside an antenna");
}

std::vector<double> read_row(const Lines& lines, std::size_t count) {
  std::vector<double> row(count);
  for (std::size_t i = 0; i < count; ++i) {
    row[i] = lines.number(8 + 8 * i, 8, "phase centre variation in mm") * 1e-3;
  }
  return row;
}

PhaseCentre read_carrier(Lines& lines, const Antenna& antenna) {
  PhaseCentre carrier;
  const auto system = system_of(lines.column(3, 1).empty() ? '?' : lines.line()[3]);
  const int band = lines.integer(4, 2, "carrier");
  if (!system || band < 1 || band > 9) lines.fail("invalid carrier; expected e.g. G01");
  carrier.system = *system;
  carrier.band = static_cast<char>('0' + band);
  const auto count = static_cast<std::size_t>(
      std::lround((antenna.zenith_last - antenna.zenith_first) / antenna.zenith_step) + 1);
  const std::size_t azimuths =
      antenna.azimuth_step > 0 ? static_cast<std::size_t>(360.0 / antenna.azimuth_step) + 1 : 0;
  for (advance(lines); label(lines) != "END OF FREQUENCY"; advance(lines)) {
    if (label(lines) == "NORTH / EAST / UP") {
      carrier.offset = {lines.number(0, 10, "offset"), lines.number(10, 10, "offset"),
                        lines.number(20, 10, "offset")};
      carrier.offset *= 1e-3;
    } else if (trimmed(lines.column(0, 8)) == "NOAZI") {
      carrier.no_azimuth = read_row(lines, count);
    } else if (label(lines) == "COMMENT") {
      continue;
    } else {
      if (carrier.azimuths.size() >= azimuths)
        lines.fail("more azimuth rows than the step in DAZI gives");
      carrier.azimuths.push_back(read_row(lines, count));
    }
  }
  if (carrier.no_azimuth.empty()) lines.fail("a carrier has no NOAZI row");
  if (!carrier.azimuths.empty() && carrier.azimuths.size() != azimuths) {
    lines.fail("a carrier has fewer azimuth rows than the step in DAZI gives");
  }
  return carrier;
}

// The rows of the carriers use the grid that was defined before them.
void require_no_carrier(const Lines& lines, const Antenna& antenna) {
  if (!antenna.carriers.empty()) lines.fail("DAZI or ZEN1 comes after a carrier");
}

void read_azimuth_grid(const Lines& lines, Antenna& antenna) {
  require_no_carrier(lines, antenna);
  antenna.azimuth_step = lines.number(2, 6, "azimuth step");
  if (antenna.azimuth_step != 0 && !(antenna.azimuth_step >= 0.1 && antenna.azimuth_step <= 180)) {
    lines.fail("an azimuth step must be 0.1 to 180 degrees, or 0");
  }
}

void read_zenith_grid(const Lines& lines, Antenna& antenna) {
  require_no_carrier(lines, antenna);
  antenna.zenith_first = lines.number(2, 6, "zenith angle");
  antenna.zenith_last = lines.number(8, 6, "zenith angle");
  antenna.zenith_step = lines.number(14, 6, "zenith step");
  if (!(antenna.zenith_first >= 0 && antenna.zenith_last <= 180 &&
        antenna.zenith_last >= antenna.zenith_first && antenna.zenith_step >= 0.1)) {
    lines.fail("invalid grid of zenith angles");
  }
}

// A satellite's antenna has the satellite, such as G05, as its serial number. A receiver's antenna
// may have the same serial number, but it has a radome behind its name and no number of a space
// vehicle. A name that fills the space before the radome is that of a satellite's antenna.
bool is_satellite_antenna(const Lines& lines) {
  const bool has_radome = blank(lines.column(15, 1)) && !blank(lines.column(16, 4));
  const bool has_vehicle = !blank(lines.column(40, 10));
  return trimmed(lines.column(20, 20)).size() == 3 && !blank(lines.column(0, 5)) &&
         (!has_radome || has_vehicle);
}

// An antenna without its end, recognized by the start of the next one, is left out and counted.
Antenna read_antenna(Lines& lines, int& refused) {
  Antenna antenna;
  for (advance(lines); label(lines) != "END OF ANTENNA"; advance(lines)) {
    const auto name = label(lines);
    if (name == "TYPE / SERIAL NO") {
      antenna.type = std::string(trimmed(lines.column(0, 20)));
      antenna.serial = std::string(trimmed(lines.column(20, 20)));
      if (is_satellite_antenna(lines)) antenna.satellite = parse_satellite(antenna.serial);
    } else if (name == "DAZI") {
      read_azimuth_grid(lines, antenna);
    } else if (name == "ZEN1 / ZEN2 / DZEN") {
      read_zenith_grid(lines, antenna);
    } else if (name == "VALID FROM") {
      antenna.valid_from = parse_stamp(lines, lines.column(0, 43));
    } else if (name == "VALID UNTIL") {
      antenna.valid_until = parse_stamp(lines, lines.column(0, 43));
    } else if (name == "START OF FREQUENCY") {
      antenna.carriers.push_back(read_carrier(lines, antenna));
    } else if (name == "START OF FREQ RMS") {
      while (label(lines) != "END OF FREQ RMS") advance(lines);
    } else if (name == "START OF ANTENNA") {
      antenna = {};
      ++refused;
    } else if (name.empty()) {
      lines.fail("unknown line in an antenna");
    }
  }
  if (antenna.type.empty()) lines.fail("an antenna has no TYPE / SERIAL NO");
  return antenna;
}

}  // namespace

const PhaseCentre* Antenna::carrier(System system, char band) const {
  for (const PhaseCentre& c : carriers) {
    if (c.system == system && c.band == band) return &c;
  }
  return nullptr;
}

AntennaFile parse_antex(std::string_view text, const std::string& file) {
  AntennaFile result;
  result.file = file;
  Lines lines(text, file);
  if (!lines.next() || label(lines) != "ANTEX VERSION / SYST") {
    lines.fail("an ANTEX file must start with ANTEX VERSION / SYST");
  }
  const double version = lines.number(0, 8, "version");
  if (version < 1.2 || version > 1.45)
    lines.fail("unknown version; ANTEX 1.2 to 1.4 are supported");
  while (label(lines) != "END OF HEADER") {
    if (!lines.next()) lines.fail("the file ends inside its header");
    if (label(lines) == "PCV TYPE / REFANT") result.absolute = lines.column(0, 1) == "A";
  }
  while (lines.next()) {
    if (label(lines) == "START OF ANTENNA") {
      result.antennas.push_back(read_antenna(lines, result.refused));
    } else if (label(lines) != "COMMENT" && !blank(lines.line())) {
      lines.fail("an antenna must start with START OF ANTENNA");
    }
  }
  if (result.antennas.empty()) lines.fail("the file contains no antenna");
  result.satellites_only = std::all_of(result.antennas.begin(), result.antennas.end(),
                                       [](const Antenna& a) { return a.satellite.has_value(); });
  return result;
}

}  // namespace maploop::ppp
