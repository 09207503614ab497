// Compares two logs message by message, channel by channel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/log/channel_filter.h"

namespace maploop::lcm_log {

// The first difference between two messages: a field by its path, "type", or "byte N" of messages
// that cannot be decoded by a known type.
struct FieldDifference {
  std::string field;
  std::string a, b;  // the field's values
};

// Returns nothing if the messages have the same bytes.
std::optional<FieldDifference> compare(std::span<const std::uint8_t> a,
                                       std::span<const std::uint8_t> b,
                                       const schema::Schema& schema);

struct ChannelDiff {
  std::string channel;
  std::uint64_t count_a = 0, count_b = 0;
  std::uint64_t differing = 0;          // among the messages that have a partner in the other log
  std::optional<std::uint64_t> number;  // of the first that differs or has no partner, from 0
  std::optional<std::int64_t> time_a_us, time_b_us;  // log time of that message, if the log has it
  std::optional<FieldDifference> field;              // if both logs have that message

  bool same() const { return !number; }
};

struct LogDiff {
  std::vector<ChannelDiff> channels;  // by name, those that the filter selects
  bool same() const;
};

// The n-th message of a channel is the partner of the n-th message of that channel in the other
// log. Only data is compared, not log time or the order between channels. Each log is read twice;
// memory is 8 bytes a message. Messages are compared by a 64-bit hash (XXH3). Throws
// std::runtime_error if a log cannot be read, is damaged, or contains more than 50 million
// messages.
LogDiff diff(const std::filesystem::path& a, const std::filesystem::path& b,
             const schema::Schema& schema, ChannelFilter channels);

// `a` and `b` are the names of the logs in the text.
std::string format_diff(const LogDiff& diff, const std::string& a, const std::string& b);

}  // namespace maploop::lcm_log
