// This file reads the 28 bytes of an event's header, and checks whether they are plausible.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "msgs/lcm/log/log_event.h"

namespace maploop::lcm_log {

inline constexpr std::uint32_t sync_word = 0xEDA1DA01;
inline constexpr std::size_t header_bytes = 28;
inline constexpr std::int32_t maximum_channel_bytes = 999;  // LCM's own limit
inline constexpr std::int32_t maximum_data_bytes = 1
                                                   << 26;  // 64 MB, more than any sensor's message

struct LogHeader {
  std::uint32_t sync = 0;
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::int32_t channel_bytes = 0;
  std::int32_t data_bytes = 0;

  std::size_t event_bytes() const {
    return header_bytes + static_cast<std::size_t>(channel_bytes) +
           static_cast<std::size_t>(data_bytes);
  }
};

// Precondition: `bytes` has at least header_bytes.
LogHeader read_header(std::span<const std::uint8_t> bytes);
void write_header(const LogHeader& header, std::span<std::uint8_t, header_bytes> bytes);

// Returns the event that the bytes are, from its header to its last byte. Precondition: they are.
LogEvent whole_event(std::span<const std::uint8_t> bytes);

// Returns why no event can begin like this; nullopt if one can.
std::optional<std::string> implausible(const LogHeader& header);

// Returns whether the bytes begin with the sync word, or with its first bytes if there are fewer.
bool begins_with_sync(std::span<const std::uint8_t> bytes);

// Accepts a sync word with at most eight wrong bits of 32; one of 286 random words matches.
bool begins_nearly_with_sync(std::span<const std::uint8_t> bytes);

// Returns where the sync word first occurs at or after `from`; bytes.size() if it does not.
std::size_t find_sync(std::span<const std::uint8_t> bytes, std::size_t from);

}  // namespace maploop::lcm_log
