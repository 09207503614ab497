#include "sensors/gnss/nmea_fixes.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

constexpr double knot = 1852.0 / 3600.0;  // m/s

// Returns 1 sigma of a position with HDOP 1, m, or nothing if the quality of a GGA is not a fix.
std::optional<double> sigma_of_quality(std::string_view quality) {
  if (quality.size() != 1) return {};
  switch (quality.front()) {
    case '1':
    case '3':
      return 3.0;
    case '2':
      return 1.0;
    case '4':
      return 0.03;
    case '5':
      return 0.3;
    default:  // no fix, dead reckoning, manual, simulated
      return {};
  }
}

}  // namespace

void NmeaFixes::take_gga(const NmeaSentence& s) {
  position_.reset();
  const auto sigma = sigma_of_quality(s.field(5));
  const auto time = nmea_time_of_day(s.field(0));
  const auto latitude = nmea_angle(s.field(1), s.field(2));
  const auto longitude = nmea_angle(s.field(3), s.field(4));
  const auto hdop = s.number(7), altitude = s.number(8), geoid = s.number(10);
  if (!sigma || !time || !latitude || !longitude || !hdop || !(*hdop > 0.0) ||
      *hdop > parameters_.max_hdop) {
    ++counts_.no_fix;
    return;
  }
  // Heights are 1.5 times as uncertain as positions, because all satellites are above the receiver.
  position_ = Position{*time,
                       {*latitude, *longitude, altitude.value_or(0.0) + geoid.value_or(0.0)},
                       *sigma * *hdop,
                       altitude ? 1.5 * *sigma * *hdop : 1000.0};
}

void NmeaFixes::take_rmc(const NmeaSentence& s) {
  motion_.reset();
  const auto time = nmea_time_of_day(s.field(0));
  const auto date = nmea_date(s.field(8));
  const auto speed = s.number(6);
  if (s.field(1) != "A" || !time || !date || !speed || *speed < 0.0) return;
  // Receivers leave the course out while they do not move.
  motion_ = Motion{*date + *time, knot * *speed, radians(s.number(7).value_or(0.0)),
                   s.field(0).substr(4, 2) == "60"};
}

void NmeaFixes::take_gst(const NmeaSentence& s) {
  errors_.reset();
  const auto time = nmea_time_of_day(s.field(0));
  const auto north = s.number(5), east = s.number(6), up = s.number(7);
  if (!time || !north || !east || !up || !(*north > 0.0 && *east > 0.0 && *up > 0.0)) return;
  errors_ = Errors{*time, *north, *east, *up};
}

bool NmeaFixes::add(std::string_view line, Time arrival, GnssFix& fix) {
  const auto sentence = parse_nmea(line);
  if (!sentence) {
    ++counts_.damaged;
    return false;
  }
  ++counts_.sentences;
  if (sentence->kind == "GST") take_gst(*sentence);
  if (sentence->kind == "GGA") {
    take_gga(*sentence);
  } else if (sentence->kind == "RMC") {
    take_rmc(*sentence);
  } else {
    return false;
  }
  return complete(arrival, fix);
}

bool NmeaFixes::complete(Time arrival, GnssFix& fix) {
  if (!position_ || !motion_) return false;
  const Duration time_of_day = motion_->time - std::chrono::floor<std::chrono::days>(motion_->time);
  if (position_->time % std::chrono::days(1) != time_of_day) return false;
  const Position position = *position_;
  const Motion motion = *motion_;
  position_.reset();
  motion_.reset();
  if (leap_ && motion.time == last_) {
    clock_.forget();  // UTC stood still for a second
  } else if (motion.time <= last_) {
    ++counts_.repeated;
    // A receiver that corrects a wrong date continues with an earlier one.
    if (last_ - motion.time > std::chrono::seconds(10)) last_ = motion.time;
    return false;
  }
  last_ = motion.time;
  leap_ = motion.leap;
  const Duration utc = motion.time.time_since_epoch();
  clock_.add(utc, arrival - from_seconds(parameters_.latency));
  utc_offset_ = utc - clock_.to_host(utc).time_since_epoch();
  fix.stamp = fix.velocity_stamp = clock_.to_host(utc);
  if (fix.stamp <= last_stamp_) {
    ++counts_.repeated;
    return false;
  }
  last_stamp_ = fix.stamp;
  fix.available = arrival;
  fix.sequence = counts_.fixes++;
  fix.position = position.position;
  Eigen::Vector3d sigma(position.sigma_horizontal, position.sigma_horizontal,
                        position.sigma_vertical);
  if (errors_ && errors_->time == time_of_day) sigma = {errors_->east, errors_->north, errors_->up};
  fix.position_covariance = sigma.cwiseAbs2().asDiagonal();
  fix.velocity_enu =
      motion.speed * Eigen::Vector3d(std::sin(motion.azimuth), std::cos(motion.azimuth), 0.0);
  fix.velocity_covariance = Eigen::Vector3d(parameters_.velocity_sigma, parameters_.velocity_sigma,
                                            parameters_.vertical_sigma)
                                .cwiseAbs2()
                                .asDiagonal();
  return true;
}

}  // namespace maploop::sensors
