// What every reader takes at most. INPUT.md beside this says what a reader may rely on, and what it
// owes its caller.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "msgs/time.h"

namespace maploop::input_limits {

constexpr std::size_t mebibyte = std::size_t{1} << 20U;

// Bytes of a file; of one that is compressed, bytes of what is in it.
constexpr std::size_t settings = mebibyte;          // what is written by hand: TOML, rules, types
constexpr std::size_t table = 64 * mebibyte;        // a text of a recorded drive
constexpr std::size_t track = 256 * mebibyte;       // fixes, poses, matches and labels
constexpr std::size_t picture = 64 * mebibyte;      // one image, compressed or not
constexpr std::size_t snapshot = 256 * mebibyte;    // of the vehicle
constexpr std::size_t gnss_file = 2048 * mebibyte;  // a day of a receiver at 10 Hz
constexpr std::size_t road_network = 4096 * mebibyte;

// Elements.
constexpr std::size_t frames = std::size_t{1} << 20U;        // of one sensor: 2.9 h at 100 Hz
constexpr std::size_t fixes = std::size_t{1} << 18U;         // of one track: 3 days at 1 Hz
constexpr std::size_t columns = 1024;                        // of one line
constexpr int pixels = 1 << 26;                              // of one image
constexpr std::size_t orbit_points = std::size_t{1} << 24U;  // a day of 190 satellites at 1 Hz
constexpr std::size_t key_depth = 32;                        // dotted parts of a key in TOML
constexpr std::size_t roads_at_node = 64;                    // where turns are restricted

// Between two samples of one sensor: the time between is computed tick by tick. A single sample
// that is further away has a wrong stamp. Where others follow it, the sensor has paused; no sensor
// pauses for longer than a day, nor begins a day after the first one.
constexpr Duration longest_gap = std::chrono::hours(1);
constexpr Duration longest_pause = std::chrono::hours(24);

// Whether two times are no further apart than `most`; of any two, also those whose difference is
// none.
constexpr bool within(Duration most, Time a, Time b) {
  const auto [first, last] = a < b ? std::pair(a, b) : std::pair(b, a);
  const std::uint64_t apart = static_cast<std::uint64_t>(to_nanoseconds(last)) -
                              static_cast<std::uint64_t>(to_nanoseconds(first));
  return apart <= static_cast<std::uint64_t>(most.count());
}

}  // namespace maploop::input_limits
