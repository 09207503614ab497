// GPS time: a clock of its own that has no leap seconds, and its way to UTC.
#pragma once

#include <string>

#include "msgs/time.h"

namespace maploop::ppp {

// Counts from 1980-01-06 00:00:00 GPS time (which was also UTC).
struct GpsClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<GpsClock, duration>;
  static constexpr bool is_steady = false;
};
using GpsTime = GpsClock::time_point;

// The days since 1970-01-01 of GPS time's first day.
inline constexpr std::chrono::sys_days gps_epoch_day{std::chrono::year{1980} / 1 / 6};

// A calendar stamp of GPS time, as files write it.
struct CalendarTime {
  int year = 1980, month = 1, day = 6, hour = 0, minute = 0;
  double second = 0.0;
};

// Throws std::invalid_argument for what is no date and time of the years 1980 to 2200. Second 60.x
// is the next minute's, as some files round.
GpsTime gps_time(const CalendarTime& stamp);
CalendarTime calendar(GpsTime t);

// Seconds of the week within [0, 604800), and the week since 1980.
GpsTime gps_week_time(int week, double seconds_of_week);
int gps_week(GpsTime t);
double seconds_of_week(GpsTime t);

// The moment nearest to `near` that is `since` after the begin of a `period` (a day, a week).
GpsTime nearest_moment(GpsTime near, Duration since, Duration period);

// "2020-06-25 00:00:30.000" (GPS time).
std::string format_gps_time(GpsTime t);

// GPS time minus UTC, by a table of leap seconds.
struct LeapSeconds {
  Duration gps_minus_utc;
  bool out_of_date;  // later than the table knows: a leap second may have been missed
};
LeapSeconds leap_seconds(Time utc);
LeapSeconds leap_seconds(GpsTime t);
// The day from which the table can no longer be trusted.
Time leap_seconds_valid_until();

Time to_utc(GpsTime t);
GpsTime from_utc(Time t);

}  // namespace maploop::ppp
