// Describes a log: for each channel its number of messages, types, rate and regularity.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct TypeCount {
  std::uint64_t fingerprint = 0;
  std::string name;  // empty if the type is unknown
  std::uint64_t count = 0;
};

// Intervals are between the log times of consecutive messages of one channel, in the order of the
// log.
struct ChannelInfo {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;                 // of data
  std::int64_t first_us = 0, last_us = 0;  // log time of the channel's first and last message
  std::vector<TypeCount> types;            // at most eight are distinguished
  double rate_hz = 0.0;                    // 0 with fewer than two messages
  double median_s = 0.0;                   // median interval, at most 0.8 % too long
  double jitter_s = 0.0;                   // standard deviation of the intervals
  double longest_s = 0.0;                  // longest interval
  std::int64_t longest_from_us = 0;        // its beginning
  std::uint64_t gaps = 0;                  // intervals above 2.5 times the median
  std::uint64_t backwards = 0;             // messages earlier than their predecessor
};

struct LogInfo {
  std::string file;
  std::uint64_t bytes = 0;  // uncompressed
  std::uint64_t events = 0;
  std::int64_t first_us = 0, last_us = 0;  // earliest and latest
  std::vector<ChannelInfo> channels;       // by name; at most 1000
  std::uint64_t events_elsewhere = 0;      // on channels beyond these
  std::uint64_t damages = 0, damaged_bytes = 0;
};

// Throws std::runtime_error naming the file if it cannot be read or contains bytes but no event.
LogInfo read_info(const std::filesystem::path& file, const schema::Schema& schema);

std::string format_table(const LogInfo& info);

// Throws std::runtime_error naming the file if it cannot be written.
void write_json(const std::filesystem::path& file, const LogInfo& info);

}  // namespace maploop::lcm_log
