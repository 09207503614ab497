#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "sensors/gnss/nmea.h"
#include "tools/evaluate/text_lines.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

using mapmatch::unknown;
using sensors::NmeaSentence;

constexpr double knot = 1852.0 / 3600.0;  // m/s
constexpr Duration half_a_day = std::chrono::hours(12);

// Returns the place that begins at a field: latitude, hemisphere, longitude, hemisphere.
Geodetic place(const NmeaSentence& s, std::size_t first) {
  return {sensors::nmea_angle(s.field(first), s.field(first + 1)).value_or(unknown),
          sensors::nmea_angle(s.field(first + 2), s.field(first + 3)).value_or(unknown), 0.0};
}

class NmeaTrackReader {
 public:
  NmeaTrackReader(std::string_view name, const TrackOptions& options)
      : name_(name), options_(options) {}

  void take(const NmeaSentence& s) {
    if (s.kind == "RMC" && s.count >= 9 && s.field(1) == "A") {
      date_ = sensors::nmea_date(s.field(8)).value_or(date_);
      mapmatch::VehicleFix& fix = at(s.field(0));
      fix.stamp = stamp(s.field(0));  // now with its date
      fix.position = place(s, 2);
      fix.speed = knot * s.number(6).value_or(unknown);
      fix.azimuth = radians(s.number(7).value_or(unknown));
    } else if (s.kind == "ZDA" && s.count >= 4 && s.field(3).size() == 4) {
      const std::string day(s.field(1)), month(s.field(2)), year(s.field(3).substr(2));
      date_ = sensors::nmea_date(day + month + year).value_or(date_);
      if (!track_.empty() && s.field(0) == time_) track_.back().stamp = stamp(time_);
    } else if (s.kind == "GGA" && s.count >= 8 && s.field(5) != "0") {
      mapmatch::VehicleFix& fix = at(s.field(0));
      fix.position = place(s, 1);
      fix.hdop = s.number(7).value_or(unknown);
    } else if (s.kind == "GST" && s.count >= 7) {
      const double north = s.number(5).value_or(0.0), east = s.number(6).value_or(0.0);
      const double least = options_.min_sigma;
      if (north > 0.0 && east > 0.0) {
        at(s.field(0)).covariance =
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
    fix.position.latitude = fix.position.longitude = unknown;
    fix.covariance = options_.sigma * options_.sigma * Eigen::Matrix2d::Identity();
    fix.stamp = stamp(time);
    if (!track_.empty() && fix.stamp + half_a_day < track_.back().stamp) {
      date_ += 2 * half_a_day;  // GGA has no date: it is after midnight
      fix.stamp = stamp(time);
    }
    keep(fix, name_, track_);
    return track_.back();
  }

  Time stamp(std::string_view time) const {
    const auto of_day = sensors::nmea_time_of_day(time);
    return of_day ? date_ + *of_day : Time{};
  }

  std::string_view name_;
  const TrackOptions& options_;
  Track track_;
  std::string time_;
  Time date_{};
};

}  // namespace

Track parse_nmea_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  NmeaTrackReader reader(name, options);
  for (evaluation::TextLines lines(text, std::string(name)); lines.next();) {
    std::string sentence(lines.line());
    if (!sentence.starts_with('$')) continue;
    if (sentence.find('*') == std::string::npos)  // checksums are optional
      sentence = sensors::nmea_sentence(sentence.substr(1));
    if (const auto parsed = sensors::parse_nmea(sentence)) reader.take(*parsed);
  }
  Track track = reader.finish();
  if (track.empty()) {
    throw std::runtime_error(std::string(name) +
                             " has no valid position in an RMC or GGA sentence");
  }
  return track;
}

}  // namespace maploop::match
