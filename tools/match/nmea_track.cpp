#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "tools/match/cells.h"
#include "tools/match/track_file.h"
#include "tools/match/track_time.h"

namespace maploop::match {
namespace {

constexpr double knot = 1852.0 / 3600.0;  // m/s

double number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty()
             ? value
             : mapmatch::unknown;
}

// Returns the fields between '$' and '*', or nothing if the line is not a sentence or its checksum
// is wrong.
std::optional<Cells> sentence(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  if (line.size() < 7 || line.front() != '$') return {};
  line.remove_prefix(1);
  if (const auto star = line.find('*'); star != std::string_view::npos) {
    unsigned sum = 0, said = 0;
    for (const char c : line.substr(0, star)) sum ^= static_cast<unsigned char>(c);
    const std::string_view hex = line.substr(star + 1);
    std::from_chars(hex.data(), hex.data() + hex.size(), said, 16);
    if (sum != said) return {};
    line = line.substr(0, star);
  }
  return split(line, ',');
}

// Converts for instance "4858.95", "N" to rad.
double angle(std::string_view digits, std::string_view hemisphere) {
  const double value = number(digits);
  const double whole = std::trunc(value / 100.0);
  const double degrees = whole + (value - 100.0 * whole) / 60.0;
  return radians(hemisphere == "S" || hemisphere == "W" ? -degrees : degrees);
}

class Reader {
 public:
  Reader(std::string_view name, const TrackOptions& options) : name_(name), options_(options) {}

  void take(const Cells& f) {
    const std::string_view kind = f[0].size() >= 3 ? f[0].substr(f[0].size() - 3) : f[0];
    if (kind == "RMC" && f.size() >= 10 && f[2] == "A") {
      date_ = f[9];
      mapmatch::VehicleFix& fix = at(f[1]);
      fix.stamp = stamp(f[1]);  // now with its date
      fix.position = {angle(f[3], f[4]), angle(f[5], f[6]), 0.0};
      fix.speed = knot * number(f[7]);
      fix.azimuth = radians(number(f[8]));
    } else if (kind == "GGA" && f.size() >= 9 && f[6] != "0") {
      mapmatch::VehicleFix& fix = at(f[1]);
      fix.position = {angle(f[2], f[3]), angle(f[4], f[5]), 0.0};
      fix.hdop = number(f[8]);
    } else if (kind == "GST" && f.size() >= 8) {
      const double north = number(f[6]), east = number(f[7]);
      if (north > 0.0 && east > 0.0) {
        const double least = options_.min_sigma;
        at(f[1]).covariance =
            Eigen::Vector2d(std::pow(std::max(least, east), 2), std::pow(std::max(least, north), 2))
                .asDiagonal();
      }
    }
  }

  Track finish() {
    std::erase_if(track_, [](const auto& fix) {
      return !std::isfinite(fix.position.latitude) || !std::isfinite(fix.position.longitude);
    });
    return std::move(track_);
  }

 private:
  // Returns the fix of a time of day; several sentences may describe the same fix.
  mapmatch::VehicleFix& at(std::string_view time) {
    if (!track_.empty() && time == time_) return track_.back();
    time_ = time;
    mapmatch::VehicleFix fix;
    fix.position.latitude = fix.position.longitude = mapmatch::unknown;
    fix.covariance = options_.sigma * options_.sigma * Eigen::Matrix2d::Identity();
    fix.stamp = stamp(time);
    keep(fix, name_, track_);
    return track_.back();
  }

  Time stamp(std::string_view time) const {
    if (time.size() < 6) return {};
    std::string text = "1970-01-01";
    if (date_.size() == 6)
      text = "20" + date_.substr(4, 2) + "-" + date_.substr(2, 2) + "-" + date_.substr(0, 2);
    text += " " + std::string(time.substr(0, 2)) + ":" + std::string(time.substr(2, 2)) + ":" +
            std::string(time.substr(4));
    return parse_track_time(text).value_or(Time{});
  }

  std::string_view name_;
  const TrackOptions& options_;
  Track track_;
  std::string_view time_;
  std::string date_;
};

}  // namespace

Track parse_nmea_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  Reader reader(name, options);
  while (!text.empty()) {
    const auto end = text.find('\n');
    if (const auto fields = sentence(text.substr(0, end))) reader.take(*fields);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  Track track = reader.finish();
  if (track.empty())
    throw std::runtime_error(std::string(name) +
                             " has no valid position in an RMC or GGA sentence");
  return track;
}

}  // namespace maploop::match
