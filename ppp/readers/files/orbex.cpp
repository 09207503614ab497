#include "ppp/readers/files/orbex.h"

#include <array>
#include <cmath>

namespace maploop::ppp {
namespace {

// Takes the next word of a text, which then begins behind it; empty at its end.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(word.size());
  return word;
}

class OrbexReader {
 public:
  OrbexReader(Lines& lines, AttitudeFile& result) : lines_(lines), result_(result) {}

  void read() {
    if (!lines_.next() || !lines_.line().starts_with("%=ORBEX"))
      lines_.fail("an ORBEX file must start with %=ORBEX");
    while (lines_.next() && !lines_.line().starts_with("%END")) {
      const auto line = lines_.line();
      if (line.starts_with('+') || line.starts_with('-')) {
        block_ = line.starts_with('+') ? trimmed(line.substr(1)) : std::string_view{};
      } else if (block_ == "FILE/DESCRIPTION") {
        check_description();
      } else if (block_ == "EPHEMERIS/DATA") {
        read_data();
      }
    }
    if (result_.points.empty()) lines_.fail("the file contains no attitudes (records ATT)");
  }

 private:
  void check_description() const {
    auto rest = lines_.line();
    const auto key = take_word(rest), value = trimmed(rest);
    if (key == "FRAME_TYPE" && value != "ECEF") {
      lines_.fail("attitudes relative to the frame " + std::string(value) +
                  " are not supported, only those relative to ECEF");
    }
    if (key == "TIME_SYSTEM" && value != "GPS")
      lines_.fail("the time system " + std::string(value) + " is not supported, only GPS");
  }

  void read_data() {
    auto rest = lines_.line();
    const auto what = take_word(rest);
    if (what == "##") {
      auto stamp = rest = trimmed(rest);
      for (int i = 0; i < 6; ++i) take_word(rest);
      stamp.remove_suffix(rest.size());  // the number of records
      const GpsTime t = parse_stamp(lines_, stamp);
      if (time_ && t <= *time_) lines_.fail("an epoch is not after the one before");
      time_ = t;
    }
    if (what != "ATT") return;
    if (!time_) lines_.fail("an attitude must stand behind an epoch, which begins with ##");
    const auto name = take_word(rest);
    const auto satellite = parse_satellite(name);
    if (!satellite)
      lines_.fail("'" + std::string(name) + "' is not a satellite; expected e.g. G05");
    if (take_word(rest) != "4") lines_.fail("an attitude must have four numbers");
    std::array<double, 4> q{};  // from the earth-fixed frame to the body, the scalar first
    for (double& part : q) {
      const auto number = parse_number(take_word(rest));
      if (!number) lines_.fail("an attitude must have four numbers");
      part = *number;
    }
    const Eigen::Quaterniond R_body_ecef(q[0], q[1], q[2], q[3]);
    if (std::abs(R_body_ecef.norm() - 1.0) > 1e-3) {
      ++result_.refused;
      return;
    }
    result_.points[*satellite].push_back({*time_, R_body_ecef.normalized().conjugate()});
  }

  Lines& lines_;
  AttitudeFile& result_;
  std::string_view block_;
  std::optional<GpsTime> time_;
};

}  // namespace

AttitudeFile parse_orbex(std::string_view text, const std::string& file) {
  AttitudeFile result;
  result.file = file;
  Lines lines(text, file);
  OrbexReader(lines, result).read();
  return result;
}

}  // namespace maploop::ppp
