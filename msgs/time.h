// Time of the vehicle: int64 nanoseconds, never a double.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace maploop {

using Duration = std::chrono::nanoseconds;

// Nanoseconds since 1970-01-01 UTC: the clock of every stamp, and (in microseconds) of LCM's utime.
using Time = std::chrono::sys_time<Duration>;

// The machine's own steady clock; only for waiting and for measuring how long something took.
using MonotonicTime = std::chrono::time_point<std::chrono::steady_clock, Duration>;

constexpr double to_seconds(Duration d) {
  return std::chrono::duration<double>(d).count();
}

constexpr double to_milliseconds(Duration d) {
  return 1e3 * to_seconds(d);
}

// Nearest nanosecond. Precondition: |seconds| < 9.2e9.
constexpr Duration from_seconds(double seconds) {
  return Duration(static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5)));
}

// The same of a number that a file gives, as a time or as the distance to one. Throws
// std::invalid_argument where it is longer than from 1970 to 2200, or not a number.
Duration checked_seconds(double seconds);

constexpr std::int64_t to_nanoseconds(Time t) {
  return t.time_since_epoch().count();
}
constexpr Time from_nanoseconds(std::int64_t ns) {
  return Time(Duration(ns));
}

// Of microseconds since 1970, as LCM's utime has them; none outside the years 1970 to 2255, which
// nanoseconds may not hold.
constexpr std::optional<Time> from_microseconds(std::int64_t us) {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  if (us < 0 || us > most) return {};
  return Time(std::chrono::microseconds(us));
}

// "2011-09-26 13:10:51.174740992" (any number of fractional digits up to nine), read as UTC.
// Throws std::invalid_argument naming the text when it is not such a stamp, or not within the
// years 1970 to 2200.
Time parse_time(std::string_view text);

// The same form with nine fractional digits.
std::string format_time(Time t);

}  // namespace maploop
