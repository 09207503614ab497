#include "ppp/readers/files/navigation.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace maploop::ppp {
namespace {

class NavigationReader {
 public:
  NavigationReader(Lines& lines, NavigationFile& result) : lines_(lines), result_(result) {
    read_header();
  }

  void read() {
    while (lines_.next()) {
      if (blank(lines_.line())) continue;
      if (!(version_ < 4.0 ? read_message() : read_record())) {
        refuse("the file ends inside a message, which is left out");
        break;
      }
    }
    keep_ionosphere_of_header();
  }

 private:
  void read_header() {
    if (!lines_.next() || trimmed(lines_.column(60, 20)) != "RINEX VERSION / TYPE") {
      lines_.fail("a RINEX file starts with RINEX VERSION / TYPE");
    }
    version_ = lines_.number(0, 9, "version");
    if (!supported_rinex(version_)) lines_.fail(unknown_rinex);
    three_ = version_ >= 3.0;
    const auto type = lines_.column(20, 1);
    if (type == "G" && !three_) {
      default_system_ = System::glonass;
    } else if (type == "H") {
      default_system_ = System::sbas;
    } else if (type == "N") {
      // RINEX 2.12 may contain another system than GPS: "E: Galileo".
      const auto system = lines_.column(40, 1);
      if (!system.empty()) default_system_ = system_of(system[0]).value_or(System::gps);
    } else {
      lines_.fail("not a navigation file: column 21 must contain N, or G or H in RINEX 2");
    }
    while (lines_.next()) {
      const auto label = trimmed(lines_.column(60, 20));
      if (label == "END OF HEADER") return;
      const auto what = label == "IONOSPHERIC CORR" ? trimmed(lines_.column(0, 4)) : label;
      if (what == "GPSA" || what == "ION ALPHA")
        read_coefficients(std::span(klobuchar_.values).first<4>());
      if (what == "GPSB" || what == "ION BETA")
        read_coefficients(std::span(klobuchar_.values).last<4>());
      if (what == "GAL") read_coefficients(level_.values);
    }
    lines_.fail("the file ends inside its header");
  }

  void read_coefficients(std::span<double> values) {
    const std::size_t first = three_ ? 5 : 2;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = lines_.number(first + 12 * i, 12, "ionospheric coefficient");
    }
  }

  // A header does not contain the date of its coefficients: it is taken from the messages after it.
  void keep_ionosphere_of_header() {
    GpsTime first = GpsTime::max(), last = GpsTime::min();
    const auto stretch = [&](const auto& messages) {
      for (const auto& m : messages) first = std::min(first, m.toe), last = std::max(last, m.toe);
    };
    stretch(result_.kepler);
    stretch(result_.glonass);
    if (first > last) return;
    for (const IonosphereCoefficients& c :
         {IonosphereCoefficients(klobuchar_), IonosphereCoefficients(level_)}) {
      if (plausible(c)) result_.ionosphere.push_back({c, first, last});
    }
  }

  // Reads a record of RINEX 4, which begins with a line such as "> EPH G01 LNAV", or passes over a
  // line of one that is not used. Returns false if the file ended inside the record.
  bool read_record() {
    if (!lines_.line().starts_with('>')) {
      if (passing_over_) return true;
      lines_.fail("expected a record of RINEX 4, which begins with e.g. '> EPH G01 LNAV'");
    }
    const auto kind = lines_.column(2, 3), source = trimmed(lines_.column(6, 3));
    const auto message = trimmed(lines_.column(10, 4));
    constexpr std::array orbits{"LNAV", "INAV", "FNAV", "D1", "D2", "FDMA", "SBAS"};
    const bool orbit = kind == "EPH" && std::ranges::find(orbits, message) != orbits.end();
    const bool ionosphere = kind == "ION" && ((source.starts_with('G') && message == "LNAV") ||
                                              (source.starts_with('E') && message == "IFNV"));
    passing_over_ = !orbit;  // behind coefficients there are flags
    if (!orbit && !ionosphere) {
      ++result_.skipped;
      return true;
    }
    return lines_.next() && (orbit ? read_message() : read_ionosphere(source.starts_with('E')));
  }

  bool read_ionosphere(bool galileo) {
    const GpsTime sent = parse_stamp(lines_, lines_.column(4, 19));
    IonosphereCoefficients coefficients;
    if (galileo) coefficients = IonisationLevel{};
    const auto read = [&](auto& of) {
      if (!read_values(of.values.size())) return false;
      std::copy_n(values_.begin(), of.values.size(), of.values.begin());
      return true;
    };
    if (!std::visit(read, coefficients)) return false;
    if (plausible(coefficients)) result_.ionosphere.push_back({coefficients, sent, sent});
    return true;
  }

  // Returns false if the file ended inside the message.
  bool read_message() {
    // RINEX 2.12 may name the system in each message, which then has the columns of RINEX 3.
    three_ = version_ >= 3.0 || system_of(lines_.line()[0]).has_value();
    const std::size_t name_width = three_ ? 3 : 2;
    Satellite satellite{default_system_, 0};
    if (three_) {
      const auto found = parse_satellite(lines_.column(0, 3));
      if (!found) {
        lines_.fail("'" + std::string(lines_.column(0, 3)) +
                    "' is not a satellite; expected e.g. G05");
      }
      satellite = *found;
    } else {
      const int number = lines_.integer(0, 2, "satellite number");
      if (number < 1) lines_.fail("a satellite's number must be 1 to 99");
      satellite.number = static_cast<std::uint8_t>(number);
    }
    const GpsTime stamp = parse_stamp(lines_, lines_.column(name_width, 20));
    const bool states = satellite.system == System::glonass || satellite.system == System::sbas;
    if (!read_values(states ? 15 : 31)) return false;
    // Version 3.05 gives GLONASS a line of status flags; some writers do so earlier or never.
    if (states && continues(lines_.peek())) lines_.next();
    if (satellite.system == System::sbas || satellite.system == System::navic) {
      ++result_.skipped;
    } else if (satellite.system == System::glonass) {
      keep_glonass(satellite, stamp);
    } else {
      keep_kepler(satellite, stamp);
    }
    return true;
  }

  // Returns whether a line belongs to the message before it, because it begins with blanks.
  bool continues(std::string_view line) const {
    const std::size_t indent = three_ ? 4 : 3;
    return line.size() > indent && blank(line.substr(0, indent));
  }

  // Reads values from this line on. Returns false if the file ends before the last one.
  bool read_values(std::size_t count) {
    const std::size_t indent = three_ ? 4 : 3;
    values_.fill(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      // The first line has three values, each other line four.
      const std::size_t place = i < 3 ? 1 + i : (i + 1) % 4;
      if (i >= 3 && place == 0 && !lines_.next()) return false;
      if (!lines_.whole() && lines_.line().size() < indent + 19 * (place + 1)) return false;
      values_[i] = lines_.number_or(indent + 19 * place, 19, 0.0, "value of a message");
    }
    return true;
  }

  void keep_glonass(Satellite satellite, GpsTime utc) {
    const GpsTime toe = utc + leap_seconds(utc).gps_minus_utc;
    const auto& v = values_;
    const GlonassMessage m{satellite,
                           toe,
                           v[0],
                           v[1],
                           Eigen::Vector3d(v[3], v[7], v[11]) * 1e3,
                           Eigen::Vector3d(v[4], v[8], v[12]) * 1e3,
                           Eigen::Vector3d(v[5], v[9], v[13]) * 1e3,
                           static_cast<int>(std::lround(std::fmod(v[10], 1e6))),
                           v[6]};
    if (!plausible(m)) {
      refuse(to_string(satellite) + ": the values cannot be an orbit of a GLONASS satellite");
      return;
    }
    result_.glonass.push_back(m);
  }

  void keep_kepler(Satellite satellite, GpsTime stamp) {
    const auto& v = values_;
    KeplerMessage m;
    const bool beidou = satellite.system == System::beidou;
    const bool galileo = satellite.system == System::galileo;
    const Duration to_gps = beidou ? Duration(std::chrono::seconds(14)) : Duration::zero();
    m.satellite = satellite;
    m.toc = stamp + to_gps;
    m.af0 = v[0], m.af1 = v[1], m.af2 = v[2];
    m.iode = v[3], m.crs = v[4], m.delta_n = v[5], m.m0 = v[6];
    m.cuc = v[7], m.e = v[8], m.cus = v[9], m.sqrt_a = v[10];
    m.cic = v[12], m.omega0 = v[13], m.cis = v[14];
    m.i0 = v[15], m.crc = v[16], m.omega = v[17], m.omega_dot = v[18];
    m.i_dot = v[19];
    m.data_sources = galileo ? v[20] : 0.0;
    m.accuracy = v[23];
    m.health = v[24];
    m.group_delay = {v[25], beidou || galileo ? v[26] : 0.0};
    if (!plausible(m) || v[11] < 0.0 || v[11] > 604800.0 || v[21] < 0.0 || v[21] > 9999.0) {
      refuse(to_string(satellite) + ": the values cannot be an orbit of a navigation satellite");
      return;
    }
    // BeiDou's weeks start 1356 weeks later, but some writers use GPS's weeks. The clock's epoch
    // determines which week is meant.
    m.toe = gps_week_time(gps_week(m.toc), v[11]) + to_gps;
    const auto week = std::chrono::hours(24 * 7);
    if (m.toe - m.toc > week / 2) m.toe -= week;
    if (m.toc - m.toe > week / 2) m.toe += week;
    result_.kepler.push_back(m);
  }

  void refuse(const std::string& why) {
    ppp::refuse(result_, lines_.file() + ":" + std::to_string(lines_.line_number()), why);
  }

  Lines& lines_;
  NavigationFile& result_;
  double version_ = 0.0;
  bool three_ = true;          // whether the columns are those of RINEX 3 and 4
  bool passing_over_ = false;  // the record of RINEX 4 that this line belongs to
  System default_system_ = System::gps;
  std::array<double, 31> values_{};
  Klobuchar klobuchar_;  // zero if not in the header
  IonisationLevel level_;
};

}  // namespace

NavigationFile parse_navigation(std::string_view text, const std::string& file) {
  NavigationFile result;
  result.file = file;
  Lines lines(text, file);
  NavigationReader(lines, result).read();
  return result;
}

}  // namespace maploop::ppp
