#include "ppp/readers/files/bias.h"

#include <algorithm>
#include <cmath>

namespace maploop::ppp {
namespace {

// Reads "2021:265:00000": year, day of the year, second of the day. Zeros in all of them mean an
// open end.
GpsTime sinex_time(const Lines& lines, std::size_t column, GpsTime open) {
  const auto text = lines.column(column, 14);
  const auto year = parse_integer(columns(text, 0, 4));
  const auto day = parse_integer(columns(text, 5, 3));
  const auto second = parse_integer(columns(text, 9, 5));
  if (!year || !day || !second || text.size() != 14 || *day > 366 || *second > 86400 || *year < 0 ||
      *day < 0 || *second < 0 || (*year > 0 && (*year < 1980 || *year > 2200))) {
    lines.fail("'" + std::string(text) + "' is not of the form YYYY:DDD:SSSSS (year, day, second)");
  }
  if (*year == 0) return open;
  return gps_time({*year, 1, 1, 0, 0, 0.0}) + std::chrono::hours(24 * (*day - 1)) +
         std::chrono::seconds(*second);
}

void read_bias(const Lines& lines, BiasFile& result) {
  const bool absolute = lines.column(1, 4) == "OSB ";
  const auto satellite = parse_satellite(lines.column(11, 3));
  const auto signal = trimmed(lines.column(25, 4));
  const auto second = trimmed(lines.column(30, 4));
  const bool in_ns = trimmed(lines.column(65, 4)) == "ns";
  const bool phase = absolute && in_ns && signal.size() == 3 && signal.starts_with('L');
  if (!satellite || !blank(lines.column(15, 9)) || !(phase || signal.starts_with('C'))) {
    ++result.skipped;
    return;
  }
  if (signal.size() != 3 || (absolute ? !second.empty() : second.size() != 3)) {
    lines.fail("'" + std::string(signal) + "' and '" + std::string(second) +
               "' are not the signals of a bias");
  }
  if (!in_ns) lines.fail("the unit of a bias must be ns");
  SignalBias bias;
  bias.satellite = *satellite;
  bias.signal = std::string(signal);
  bias.second = std::string(second);
  bias.from = sinex_time(lines, 35, GpsTime::min());
  bias.until = sinex_time(lines, 50, GpsTime::max());
  const double ns = lines.number(70, 21, "bias");
  if (std::abs(ns) > 1e5) lines.fail("a bias must be within 100 us");
  bias.metres = ns * 1e-9 * speed_of_light;
  result.biases.push_back(bias);
}

}  // namespace

BiasFile parse_bias_sinex(std::string_view text, const std::string& file) {
  BiasFile result;
  result.file = file;
  Lines lines(text, file);
  if (!lines.next() || lines.column(0, 5) != "%=BIA") {
    lines.fail("a Bias-SINEX file must start with %=BIA");
  }
  result.agency = std::string(trimmed(lines.column(11, 3)));
  bool solution = false, ended = false;
  while (lines.next()) {
    if (lines.line().starts_with("+BIAS/SOLUTION")) {
      solution = true;
    } else if (lines.line().starts_with("-BIAS/SOLUTION")) {
      solution = false;
      ended = true;
    } else if (solution && !lines.line().starts_with("*")) {
      const auto kind = lines.column(1, 4);
      if (kind == "OSB " || kind == "DSB ") {
        read_bias(lines, result);
      } else if (kind == "ISB ") {
        ++result.skipped;
      } else {
        lines.fail("a bias must be an OSB, DSB or ISB");
      }
    }
  }
  if (!ended) lines.fail("the file ends before -BIAS/SOLUTION");
  if (result.biases.empty()) lines.fail("the file contains no bias of a satellite");
  return result;
}

BiasFile parse_dcb(std::string_view text, const std::string& file) {
  BiasFile result;
  result.file = file;
  result.agency = "CODE";
  Lines lines(text, file);
  std::string first, second;
  bool table = false;
  int year = 0, month = 0;
  while (lines.next()) {
    const auto line = lines.line();
    if (const auto at = line.find("YEAR "); at != std::string_view::npos && year == 0) {
      year = lines.integer(at + 5, 4, "year");
      const auto m = line.find("MONTH ");
      if (m != std::string_view::npos) month = lines.integer(m + 6, 2, "month");
    }
    if (const auto at = line.find("DIFFERENTIAL (P"); at != std::string_view::npos) {
      const auto names = line.substr(at + 14, 5);
      if (names != "P1-C1" && names != "P2-C2" && names != "P1-P2") {
        lines.fail("unknown difference; P1-C1, P2-C2 and P1-P2 are supported");
      }
      first = names[1] == '1' ? "C1W" : "C2W";
      second = names == "P1-C1" ? "C1C" : names == "P2-C2" ? "C2C" : "C2W";
    }
    if (line.starts_with("***")) {
      table = true;
      continue;
    }
    if (!table || blank(line)) continue;
    const auto satellite = parse_satellite(lines.column(0, 3));
    if (!satellite || !blank(lines.column(3, 20))) {
      ++result.skipped;
      continue;
    }
    if (first.empty())
      lines.fail("the title does not contain a difference such as DIFFERENTIAL (P1-C1)");
    if (year < 1980 || year > 2200 || month < 1 || month > 12) {
      lines.fail("the title does not contain the year and month");
    }
    SignalBias bias{*satellite,
                    first,
                    second,
                    gps_time({year, month, 1, 0, 0, 0.0}),
                    gps_time({month == 12 ? year + 1 : year, month % 12 + 1, 1, 0, 0, 0.0}),
                    0.0};
    if (satellite->system == System::glonass) {
      for (std::string* name : {&bias.signal, &bias.second}) {
        std::replace(name->begin(), name->end(), 'W', 'P');
      }
    }
    bias.metres = lines.number(23, 12, "bias in ns") * 1e-9 * speed_of_light;
    result.biases.push_back(bias);
  }
  if (result.biases.empty()) lines.fail("the file contains no code bias of a satellite");
  return result;
}

}  // namespace maploop::ppp
