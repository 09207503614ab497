// Defines GPS time, a separate clock without leap seconds, and its conversion to UTC.
#pragma once

#include <string>

#include "msgs/time.h"

namespace maploop::ppp {

// It counts from 1980-01-06 00:00:00 GPS time, when GPS time and UTC were equal.
struct GpsClock {
  using duration = Duration;        // nanoseconds
  using rep = duration::rep;        // type of the number of nanoseconds
  using period = duration::period;  // one nanosecond, as a fraction of a second
  using time_point = std::chrono::time_point<GpsClock, duration>;  // the same as GpsTime
  static constexpr bool is_steady = false;  // as std::chrono asks; there is no now()
};
// A GpsTime is a moment of GPS time.
using GpsTime = GpsClock::time_point;

// This is the first day of GPS time, as the number of days since 1970-01-01.
inline constexpr std::chrono::sys_days gps_epoch_day{std::chrono::year{1980} / 1 / 6};

// A CalendarTime is a calendar stamp of GPS time as files write it.
struct CalendarTime {
  int year = 1980, month = 1, day = 6, hour = 0, minute = 0;  // month and day count from 1
  double second = 0.0;                                        // s, with its fraction
};

// Throws std::invalid_argument if the stamp is not a date and time of the years 1980 to 2200.
// Second 60.x counts as the next minute, because some files round up to it.
GpsTime gps_time(const CalendarTime& stamp);
// Returns the stamp of a moment; its second is below 60.
CalendarTime calendar(GpsTime t);

// Returns a moment by its week, which counts from 1980 without rollover, and its seconds within it.
GpsTime gps_week_time(int week, double seconds_of_week);
// Returns the week of a moment.
int gps_week(GpsTime t);
// Returns the seconds (s) of a moment since its week began.
double seconds_of_week(GpsTime t);

// Returns the moment nearest to `near` that lies `since` after the start of a `period` (a day, a
// week).
GpsTime nearest_moment(GpsTime near, Duration since, Duration period);

// Formats as "2020-06-25 00:00:30.000" (GPS time).
std::string format_gps_time(GpsTime t);

// LeapSeconds is the difference of GPS time minus UTC, from a table of leap seconds.
struct LeapSeconds {
  Duration gps_minus_utc;  // whole seconds; 0 at the start of GPS time
  // True after the end of the table: a leap second may be missing.
  bool out_of_date;
};
// Returns the difference at a moment of UTC.
LeapSeconds leap_seconds(Time utc);
// Returns the difference at a moment of GPS time.
LeapSeconds leap_seconds(GpsTime t);
// Returns the day from which on the table may be incomplete.
Time leap_seconds_valid_until();

// Returns the UTC of a moment. A leap second has the same UTC as the second after it.
Time to_utc(GpsTime t);
// Returns the GPS time of a moment of UTC.
GpsTime from_utc(Time t);

}  // namespace maploop::ppp
