// This file defines the limits of every reader. INPUT.md beside it states what a reader may rely on
// and what it must guarantee.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "msgs/time.h"

namespace maploop::input_limits {

constexpr std::size_t mebibyte = std::size_t{1} << 20U;

// These are bytes of a file; for a compressed file, bytes after decompression.
constexpr std::size_t settings = mebibyte;          // written by hand: TOML, rules, types
constexpr std::size_t table = 64 * mebibyte;        // a text of a recorded drive
constexpr std::size_t track = 256 * mebibyte;       // fixes, poses, matches and labels
constexpr std::size_t picture = 64 * mebibyte;      // one image, compressed or not
constexpr std::size_t cloud = 64 * mebibyte;        // one cloud of points, compressed or not
constexpr std::size_t snapshot = 256 * mebibyte;    // of the vehicle
constexpr std::size_t chunk = 256 * mebibyte;       // of a bag, or one message; 1 to 4 are usual
constexpr std::size_t height_tile = 32 * mebibyte;  // SRTM1 has 26 MB
constexpr std::size_t geoid_grid = 256 * mebibyte;  // EGM96 every 15 minutes has 4 MB
constexpr std::size_t gnss_file = 2048 * mebibyte;  // a day of a receiver at 10 Hz
constexpr std::size_t map_tile = 64 * mebibyte;
constexpr std::size_t road_network = 4096 * mebibyte;
constexpr std::size_t unpacked_bag = 65536 * mebibyte;  // a whole one, inflated on the disk

// These are numbers of elements.
constexpr std::size_t frames = std::size_t{1} << 20U;        // of one sensor: 2.9 h at 100 Hz
constexpr std::size_t fixes = std::size_t{1} << 18U;         // of one track: 3 days at 1 Hz
constexpr std::size_t columns = 1024;                        // of one line
constexpr int pixels = 1 << 26;                              // of one image
constexpr std::size_t orbit_points = std::size_t{1} << 24U;  // a day of 190 satellites at 1 Hz
constexpr std::size_t key_depth = 32;                        // dotted parts of a key in TOML
constexpr std::size_t roads_at_node = 64;                    // at which turns are restricted

// These limit the time between two samples of one sensor, which is computed tick by tick. A single
// sample that is further away has a wrong stamp. If others follow it, the sensor has paused; no
// sensor pauses for longer than a day, or begins more than a day after the first one.
constexpr Duration longest_gap = std::chrono::hours(1);
constexpr Duration longest_pause = std::chrono::hours(24);

// Returns whether two times are at most `most` apart. It also works for times whose difference
// overflows Duration.
constexpr bool within(Duration most, Time a, Time b) {
  const auto [first, last] = a < b ? std::pair(a, b) : std::pair(b, a);
  const std::uint64_t apart = static_cast<std::uint64_t>(to_nanoseconds(last)) -
                              static_cast<std::uint64_t>(to_nanoseconds(first));
  return apart <= static_cast<std::uint64_t>(most.count());
}

}  // namespace maploop::input_limits
