// One event of an LCM log, and what a log calls damage.
//
// The format (LCM, "Log file format"): events follow each other without gaps, each a header of 28
// bytes (sync word 0xEDA1DA01, event number int64, time int64 in microseconds since 1970-01-01,
// channel length int32, data length int32, all big-endian), then the channel's name and the data.
// There is no checksum.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace maploop::lcm_log {

// Channel and data are views, valid until their reader goes on.
struct LogEvent {
  std::int64_t number = 0;   // as the log counts it
  std::int64_t time_us = 0;  // since 1970-01-01 UTC
  std::string_view channel = {};
  std::span<const std::uint8_t> data = {};
  std::uint64_t offset = 0;  // of its header in the (uncompressed) log
  bool doubtful = false;     // damage follows it directly, and its last bytes may be damaged too
};

// Bytes of a log that are no event.
struct Damage {
  std::uint64_t begin = 0, end = 0;  // [begin, end)
  std::string reason;
};

}  // namespace maploop::lcm_log
