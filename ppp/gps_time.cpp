#include "ppp/gps_time.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace maploop::ppp {
namespace {

using namespace std::chrono;

// From each of these days on, GPS time is one second further ahead of UTC (IERS Bulletin C).
constexpr std::array<sys_days, 18> leap_days{
    sys_days{1981y / 7 / 1}, sys_days{1982y / 7 / 1}, sys_days{1983y / 7 / 1},
    sys_days{1985y / 7 / 1}, sys_days{1988y / 1 / 1}, sys_days{1990y / 1 / 1},
    sys_days{1991y / 1 / 1}, sys_days{1992y / 7 / 1}, sys_days{1993y / 7 / 1},
    sys_days{1994y / 7 / 1}, sys_days{1996y / 1 / 1}, sys_days{1997y / 7 / 1},
    sys_days{1999y / 1 / 1}, sys_days{2006y / 1 / 1}, sys_days{2009y / 1 / 1},
    sys_days{2012y / 7 / 1}, sys_days{2015y / 7 / 1}, sys_days{2017y / 1 / 1}};
// Bulletin C 70 announced no leap second for the end of December 2025.
constexpr sys_days known_until{2026y / 7 / 1};

constexpr auto week_length = hours(24 * 7);

}  // namespace

GpsTime gps_time(const CalendarTime& s) {
  const auto date = year{s.year} / s.month / s.day;
  if (!date.ok() || s.year < 1980 || s.year > 2200 || s.hour < 0 || s.hour > 24 || s.minute < 0 ||
      s.minute > 59 || !(s.second >= 0.0 && s.second < 61.0)) {
    throw std::invalid_argument("not a date and time of the years 1980 to 2200");
  }
  const Duration since_epoch = sys_days{date} - gps_epoch_day;
  if (since_epoch < Duration::zero())
    throw std::invalid_argument("before the first day of GPS time, 1980-01-06");
  return GpsTime(since_epoch + hours(s.hour) + minutes(s.minute) + from_seconds(s.second));
}

CalendarTime calendar(GpsTime t) {
  const Duration since = t.time_since_epoch();
  const auto day_number = floor<days>(since);
  const year_month_day date{gps_epoch_day + day_number};
  const hh_mm_ss clock{since - day_number};
  return {int(date.year()),
          static_cast<int>(unsigned(date.month())),
          static_cast<int>(unsigned(date.day())),
          static_cast<int>(clock.hours().count()),
          static_cast<int>(clock.minutes().count()),
          to_seconds(clock.seconds() + clock.subseconds())};
}

GpsTime gps_week_time(int week, double second) {
  return GpsTime(week_length * week + from_seconds(second));
}

int gps_week(GpsTime t) {
  return static_cast<int>(t.time_since_epoch() / week_length);
}

double seconds_of_week(GpsTime t) {
  return to_seconds(t.time_since_epoch() % week_length);
}

GpsTime nearest_moment(GpsTime near, Duration since, Duration period) {
  const Duration age = near.time_since_epoch();
  GpsTime t(age - age % period + since);
  while (t - near > period / 2) t -= period;
  while (near - t > period / 2) t += period;
  return t;
}

std::string format_gps_time(GpsTime t) {
  const auto rounded = GpsTime(round<milliseconds>(t.time_since_epoch()));
  const CalendarTime c = calendar(rounded);
  char text[96];
  std::snprintf(text, sizeof text, "%04d-%02d-%02d %02d:%02d:%06.3f", c.year, c.month, c.day,
                c.hour, c.minute, c.second);
  return text;
}

LeapSeconds leap_seconds(Time utc) {
  int count = 0;
  for (const sys_days& day : leap_days) count += utc >= day;
  return {seconds(count), utc >= known_until};
}

LeapSeconds leap_seconds(GpsTime t) {
  return leap_seconds(to_utc(t));
}

Time leap_seconds_valid_until() {
  return known_until;
}

Time to_utc(GpsTime t) {
  const Time as_if_utc = Time(gps_epoch_day) + t.time_since_epoch();
  int count = 0;
  for (const sys_days& day : leap_days) count += as_if_utc >= day + seconds(count + 1);
  return as_if_utc - seconds(count);
}

GpsTime from_utc(Time t) {
  return GpsTime(t - Time(gps_epoch_day) + leap_seconds(t).gps_minus_utc);
}

}  // namespace maploop::ppp
