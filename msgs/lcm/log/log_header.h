// The header of an event: what its 28 bytes say, and whether an event can look like that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace maploop::lcm_log {

inline constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
inline constexpr std::size_t kSyncWordBytes = 4;
inline constexpr std::size_t kHeaderBytes = 28;

struct LogHeader {
  std::uint32_t sync = 0;
  std::int64_t number = 0;
  std::int64_t time_us = 0;
  std::int32_t channel_bytes = 0;
  std::int32_t data_bytes = 0;

  std::size_t event_bytes() const {
    return kHeaderBytes + static_cast<std::size_t>(channel_bytes) +
           static_cast<std::size_t>(data_bytes);
  }
};

struct LogLimits {
  std::int32_t channel_bytes = 999;   // LCM's own
  std::int32_t data_bytes = 1 << 26;  // 64 MB, more than any sensor's message; bounds the memory
};

// Precondition: at least kHeaderBytes.
LogHeader read_header(std::span<const std::uint8_t> bytes);
void write_header(const LogHeader& header, std::span<std::uint8_t, kHeaderBytes> bytes);

// Why no event can begin like this; nullopt where one can.
std::optional<std::string> implausible(const LogHeader& header, const LogLimits& limits);

// Whether the bytes begin with the sync word, or with as much of it as there are bytes.
bool begins_with_sync(std::span<const std::uint8_t> bytes);

// A sync word in which at most eight of 32 bits are wrong; one of 286 random words is that close.
bool begins_nearly_with_sync(std::span<const std::uint8_t> bytes);

// Where the sync word first is, from `from` on; bytes.size() where it is nowhere.
std::size_t find_sync(std::span<const std::uint8_t> bytes, std::size_t from);

}  // namespace maploop::lcm_log
