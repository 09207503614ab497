#include "ppp/readers/files/observation_header.h"

#include <algorithm>

#include "ppp/readers/streams/epoch_builder.h"

namespace maploop::ppp {
namespace {

constexpr int max_types = 120;

std::string_view label(const Lines& lines) {
  return header_label(lines.line());
}

std::string text_of(std::string_view columns) {
  return std::string(trimmed(columns));
}

// RINEX 2.12 names civil codes that have their own signal by a letter in place of the band.
struct CivilSignal {
  char letter, band, attribute;
  std::string_view systems;
};
constexpr std::array civil_signals{
    CivilSignal{'A', '1', 'C', "GRJS"}, CivilSignal{'B', '1', 'X', "GJ"},
    CivilSignal{'C', '2', 'X', "GJ"}, CivilSignal{'D', '2', 'C', "R"}};

// Converts RINEX 2's two letters to RINEX 3's three, for a system. The phase goes with the civil
// code on the first carrier and with P(Y) on the second, because version 2 does not state which
// code tracked it.
ObservationType type_of_version2(System system, char kind, char band) {
  for (const CivilSignal& civil : civil_signals) {
    if (band != civil.letter) continue;
    if (civil.systems.find(letter(system)) == std::string_view::npos) return {};
    return {kind, civil.band, civil.attribute};
  }
  ObservationType type{kind == 'P' ? 'C' : kind, band, 'C'};
  const bool precise = kind == 'P' || (kind != 'C' && band == '2');
  switch (system) {
    case System::gps:
      if (band == '1') type.attribute = kind == 'P' ? 'W' : 'C';
      if (band == '2') type.attribute = precise ? 'W' : 'X';
      if (band == '5') type.attribute = 'X';
      break;
    case System::glonass:
      type.attribute = precise ? 'P' : 'C';
      break;
    case System::beidou:
      type.attribute = 'I';
      break;
    case System::sbas:
      type.attribute = band == '1' ? 'C' : 'I';
      break;
    default:
      type.attribute = 'X';
  }
  return type;
}

void number_signals(ObservationHeader& header) {
  for (std::size_t s = 0; s < header.types.size(); ++s) {
    std::vector<std::pair<char, char>> signals;
    for (ObservationType& type : header.types[s]) {
      if (std::string_view("CLDS").find(type.kind) == std::string_view::npos) continue;
      const std::pair name(type.band, type.attribute);
      const auto at = std::find(signals.begin(), signals.end(), name);
      type.signal = static_cast<int>(at - signals.begin());
      if (at == signals.end()) signals.push_back(name);
    }
    header.signals_of[s] = static_cast<int>(signals.size());
  }
}

int count_of_types(const Lines& lines, std::size_t first, std::size_t width) {
  const int count = lines.integer(first, width, "number of observation types");
  if (count < 1 || count > max_types)
    lines.fail("the number of observation types must be 1 to 120");
  return count;
}

void read_types2(Lines& lines, ObservationHeader& header) {
  const int count = count_of_types(lines, 0, 6);
  for (auto& types : header.types) types.clear();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && i % 9 == 0 && (!lines.next() || label(lines) != "# / TYPES OF OBSERV")) {
      lines.fail("the list of observation types ends after " + std::to_string(i) + " of " +
                 std::to_string(count));
    }
    const auto name = trimmed(lines.column(6 + 6 * static_cast<std::size_t>(i % 9), 6));
    if (name.size() != 2) {
      lines.fail("'" + std::string(name) + "' is not an observation type");
    }
    for (std::size_t s = 0; s < header.types.size(); ++s) {
      header.types[s].push_back(type_of_version2(static_cast<System>(s), name[0], name[1]));
    }
  }
  number_signals(header);
}

System system_in(const Lines& lines) {
  const auto system = lines.line().empty() ? std::nullopt : system_of(lines.line()[0]);
  if (!system) lines.fail("the first column must contain a satellite system: G R E C J S or I");
  return *system;
}

void read_types3(Lines& lines, ObservationHeader& header) {
  const System system = system_in(lines);
  const int count = count_of_types(lines, 3, 3);
  auto& types = header.types[static_cast<std::size_t>(system)];
  types.clear();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && i % 13 == 0 && (!lines.next() || label(lines) != "SYS / # / OBS TYPES")) {
      lines.fail("the list of observation types ends after " + std::to_string(i) + " of " +
                 std::to_string(count));
    }
    const auto name = lines.column(7 + 4 * static_cast<std::size_t>(i % 13), 3);
    if (blank(name) || name.size() != 3) {
      lines.fail("'" + std::string(name) + "' is not an observation type");
    }
    ObservationType type{name[0], name[1], name[2]};
    // RINEX 3.02 called BeiDou's B1I band 1, and some writers still do: later versions have no 1I
    // and 1Q, but another signal is 1X there.
    if (system == System::beidou && type.band == '1' &&
        (type.attribute == 'I' || type.attribute == 'Q' ||
         (type.attribute == 'X' && header.version < 3.03))) {
      type.band = '2';
    }
    types.push_back(type);
  }
  number_signals(header);
}

void read_scale_factor(Lines& lines, ObservationHeader& header) {
  const System system = system_in(lines);
  const int factor = lines.integer(2, 4, "scale factor");
  if (factor != 1 && factor != 10 && factor != 100 && factor != 1000) {
    lines.fail("a scale factor must be 1, 10, 100 or 1000");
  }
  const int count = lines.integer_or(8, 2, 0, "number of scaled types");
  auto& types = header.types[static_cast<std::size_t>(system)];
  if (count == 0) {
    for (auto& type : types) type.factor = factor;
  }
  for (int i = 0; i < count; ++i) {
    if (i > 0 && i % 12 == 0) lines.next();
    const auto name = lines.column(11 + 4 * static_cast<std::size_t>(i % 12), 3);
    for (auto& type : types) {
      if (name == std::string{type.kind, type.band, type.attribute}) type.factor = factor;
    }
  }
}

void read_glonass_channels(const Lines& lines, ObservationHeader& header) {
  for (std::size_t i = 0; i < 8; ++i) {
    const auto entry = lines.column(4 + 7 * i, 6);
    if (blank(entry)) continue;
    const auto satellite = parse_satellite(entry.substr(0, 3));
    const auto channel = parse_integer(columns(entry, 3, 3));
    if (!satellite || !channel || *channel < -7 || *channel > 6) {
      lines.fail("'" + std::string(entry) +
                 "' is not a GLONASS satellite with its channel; expected e.g. R01  1");
    }
    header.glonass_channels[satellite->number] = *channel;
  }
}

// No position needs these stamps, so that one that cannot be read is taken as not given.
std::optional<GpsTime> stamp_of_header(const Lines& lines) {
  try {
    return parse_stamp(lines, lines.column(0, 43));
  } catch (const ReadError&) {
    return {};
  }
}

Duration offset_of_time_system(const Lines& lines, const ObservationHeader& header, char type) {
  const auto name = trimmed(lines.column(48, 3));
  if (name == "GLO" || (name.empty() && type == 'R')) {
    if (!header.first) lines.fail("no valid date, which determines GLONASS's leap seconds");
    return leap_seconds(*header.first).gps_minus_utc;
  }
  if (name == "BDT" || (name.empty() && type == 'C')) return std::chrono::seconds(14);
  if (!name.empty() && name != "GPS" && name != "GAL" && name != "QZS" && name != "IRN") {
    lines.fail("'" + std::string(name) +
               "' is not a time system; expected GPS, GLO, GAL, QZS, BDT or IRN");
  }
  return Duration::zero();
}

}  // namespace

std::string_view header_label(std::string_view line) {
  return trimmed(columns(line, 60, 20));
}

void apply_header_record(Lines& lines, HeaderInForce& in_force) {
  ObservationHeader& header = in_force.header;
  const auto name = label(lines);
  if (name == "# / TYPES OF OBSERV") {
    if (in_force.version3())
      lines.fail("a list of observation types in the form of RINEX 2 in a file of RINEX 3");
    read_types2(lines, header);
  } else if (name == "SYS / # / OBS TYPES") {
    if (!in_force.version3())
      lines.fail("a list of observation types in the form of RINEX 3 in a file of RINEX 2");
    read_types3(lines, header);
  } else if (name == "SYS / SCALE FACTOR") {
    read_scale_factor(lines, header);
  } else if (name == "MARKER NAME") {
    header.marker = text_of(lines.column(0, 60));
  } else if (name == "REC # / TYPE / VERS") {
    header.receiver = text_of(lines.column(20, 20));
  } else if (name == "ANT # / TYPE") {
    header.antenna = text_of(lines.column(20, 16));
    header.radome = text_of(lines.column(36, 4));
  } else if (name == "APPROX POSITION XYZ") {
    const Eigen::Vector3d p(lines.number_or(0, 14, 0, "coordinate"),
                            lines.number_or(14, 14, 0, "coordinate"),
                            lines.number_or(28, 14, 0, "coordinate"));
    if (p.norm() > 1e6) header.approximate_position = p;
  } else if (name == "ANTENNA: DELTA H/E/N") {
    header.antenna_delta_enu = {lines.number_or(14, 14, 0, "offset"),
                                lines.number_or(28, 14, 0, "offset"),
                                lines.number_or(0, 14, 0, "offset")};
  } else if (name == "INTERVAL") {
    header.interval = parse_number(lines.column(0, 10)).value_or(0.0);
  } else if (name == "GLONASS SLOT / FRQ #") {
    read_glonass_channels(lines, header);
  }
}

void take_event(HeaderInForce& in_force, const Lines& lines, Observations& result) {
  result.header.types = in_force.header.types;
  result.header.signals_of = in_force.header.signals_of;
  if (in_force.header.antenna_delta_enu == result.header.antenna_delta_enu) return;
  refuse(result, lines,
         "the antenna is moved on its marker (ANTENNA: DELTA H/E/N), which is not followed: "
         "positions are those of the marker only until here; split the file");
  in_force.header.antenna_delta_enu = result.header.antenna_delta_enu;
}

HeaderInForce read_observation_header(Lines& lines) {
  HeaderInForce in_force;
  ObservationHeader& header = in_force.header;
  if (label(lines) != "RINEX VERSION / TYPE") {
    lines.fail("a RINEX file starts with RINEX VERSION / TYPE");
  }
  header.version = lines.number(0, 9, "version");
  if (!supported_rinex(header.version)) lines.fail(unknown_rinex);
  if (lines.column(20, 1) != "O") lines.fail("not an observation file: column 21 must contain O");
  const char type = columns(lines.line(), 40, 1).empty() ? ' ' : lines.line()[40];
  while (lines.next()) {
    const auto name = label(lines);
    if (name == "END OF HEADER") {
      if (std::all_of(header.types.begin(), header.types.end(),
                      [](const auto& types) { return types.empty(); })) {
        lines.fail("the header contains no observation types");
      }
      if (header.first) *header.first += in_force.to_gps;
      if (header.last) *header.last += in_force.to_gps;
      return in_force;
    }
    if (name == "TIME OF FIRST OBS") {
      header.first = stamp_of_header(lines);
      in_force.to_gps = offset_of_time_system(lines, header, type);
    } else if (name == "TIME OF LAST OBS") {
      header.last = stamp_of_header(lines);
    } else {
      apply_header_record(lines, in_force);
    }
  }
  lines.fail("the file ends inside its header");
}

}  // namespace maploop::ppp
