// Defines GPS time, a separate clock without leap seconds, and its conversion to UTC.
#pragma once

#include <string>

#include "msgs/time.h"

namespace maploop::ppp {

// It counts from 1980-01-06 00:00:00 GPS time, when GPS time and UTC were equal.
struct GpsClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<GpsClock, duration>;
  static constexpr bool is_steady = false;
};
using GpsTime = GpsClock::time_point;

// This is the first day of GPS time, as the number of days since 1970-01-01.
inline constexpr std::chrono::sys_days gps_epoch_day{std::chrono::year{1980} / 1 / 6};

// A CalendarTime is a calendar stamp of GPS time as files write it.
struct CalendarTime {
  int year = 1980, month = 1, day = 6, hour = 0, minute = 0;
  double second = 0.0;
};

// Throws std::invalid_argument if the stamp is not a date and time of the years 1980 to 2200.
// Second 60.x counts as the next minute, because some files round up to it.
GpsTime gps_time(const CalendarTime& stamp);
CalendarTime calendar(GpsTime t);

// The week counts from 1980, without rollover; the seconds of the week are within [0, 604800).
GpsTime gps_week_time(int week, double seconds_of_week);
int gps_week(GpsTime t);
double seconds_of_week(GpsTime t);

// Returns the moment nearest to `near` that lies `since` after the start of a `period` (a day, a
// week).
GpsTime nearest_moment(GpsTime near, Duration since, Duration period);

// Formats as "2020-06-25 00:00:30.000" (GPS time).
std::string format_gps_time(GpsTime t);

// LeapSeconds is the difference of GPS time minus UTC, from a table of leap seconds.
struct LeapSeconds {
  Duration gps_minus_utc;
  // True after the end of the table: a leap second may be missing.
  bool out_of_date;
};
LeapSeconds leap_seconds(Time utc);
LeapSeconds leap_seconds(GpsTime t);
// Returns the day from which on the table may be incomplete.
Time leap_seconds_valid_until();

Time to_utc(GpsTime t);
GpsTime from_utc(Time t);

}  // namespace maploop::ppp
