// This file defines the time of the vehicle: int64 nanoseconds, never a double.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace maploop {

// This is every difference of times, in ns; it may be negative.
using Duration = std::chrono::nanoseconds;

// Nanoseconds since 1970-01-01 UTC. Every stamp uses this clock, and (in microseconds) LCM's utime.
using Time = std::chrono::sys_time<Duration>;

// This is the machine's own steady clock, used only to wait and to measure durations.
using MonotonicTime = std::chrono::time_point<std::chrono::steady_clock, Duration>;

// Converts to s, for calculations and output; times themselves stay integers.
constexpr double to_seconds(Duration d) {
  return std::chrono::duration<double>(d).count();
}

// Converts to ms.
constexpr double to_milliseconds(Duration d) {
  return 1e3 * to_seconds(d);
}

// Rounds to the nearest nanosecond. Precondition: |seconds| < 9.2e9.
constexpr Duration from_seconds(double seconds) {
  return Duration(static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5)));
}

// Does the same for a number from a file, used as a time or as a difference of times. Throws
// std::invalid_argument if it is longer than from 1970 to 2200, or not a number.
Duration checked_seconds(double seconds);

// Returns the nanoseconds since 1970-01-01 UTC.
constexpr std::int64_t to_nanoseconds(Time t) {
  return t.time_since_epoch().count();
}
// Does the reverse.
constexpr Time from_nanoseconds(std::int64_t ns) {
  return Time(Duration(ns));
}

// Converts microseconds since 1970, the unit of LCM's utime. Returns nothing outside the years 1970
// to 2255, which might overflow the nanoseconds.
constexpr std::optional<Time> from_microseconds(std::int64_t us) {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  if (us < 0 || us > most) return {};
  return Time(std::chrono::microseconds(us));
}

// Parses "2011-09-26 13:10:51.174740992" (up to nine fractional digits) as UTC. Throws
// std::invalid_argument that names the text if it is not such a stamp, or not within the years 1970
// to 2200.
Time parse_time(std::string_view text);

// Returns the same form with nine fractional digits.
std::string format_time(Time t);

}  // namespace maploop
