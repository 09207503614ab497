// This file defines one event of an LCM log, and damage in a log.
//
// In the format (LCM, "Log file format") events follow each other without gaps. Each has a header
// of 28 bytes (sync word 0xEDA1DA01, event number int64, time int64 in microseconds since
// 1970-01-01, channel length int32, data length int32, all big-endian), then the channel's name and
// the data. There is no checksum.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace maploop::lcm_log {

// Channel and data are views, valid until the reader's next step.
struct LogEvent {
  std::int64_t number = 0;   // the log's own count
  std::int64_t time_us = 0;  // since 1970-01-01 UTC
  std::string_view channel = {};
  std::span<const std::uint8_t> data = {};
  std::uint64_t offset = 0;  // of its header in the (uncompressed) log
};

// These are bytes of a log that do not belong to any event.
struct Damage {
  std::uint64_t begin = 0, end = 0;  // [begin, end)
  std::string reason;

  std::uint64_t bytes() const { return end - begin; }
};

}  // namespace maploop::lcm_log
