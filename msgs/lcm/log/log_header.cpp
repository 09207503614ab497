#include "msgs/lcm/log/log_header.h"

#include <algorithm>
#include <array>
#include <bit>

namespace maploop::lcm_log {
namespace {

constexpr std::array<std::uint8_t, 4> sync_bytes{0xED, 0xA1, 0xDA, 0x01};

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

void put_big_endian(std::uint64_t value, std::span<std::uint8_t> bytes) {
  for (std::size_t i = bytes.size(); i-- > 0; value >>= 8) {
    bytes[i] = static_cast<std::uint8_t>(value);
  }
}

}  // namespace

LogHeader read_header(std::span<const std::uint8_t> bytes) {
  return {.sync = static_cast<std::uint32_t>(big_endian(bytes.first(4))),
          .number = static_cast<std::int64_t>(big_endian(bytes.subspan(4, 8))),
          .time_us = static_cast<std::int64_t>(big_endian(bytes.subspan(12, 8))),
          .channel_bytes = static_cast<std::int32_t>(big_endian(bytes.subspan(20, 4))),
          .data_bytes = static_cast<std::int32_t>(big_endian(bytes.subspan(24, 4)))};
}

void write_header(const LogHeader& header, std::span<std::uint8_t, header_bytes> bytes) {
  put_big_endian(header.sync, bytes.first(4));
  put_big_endian(static_cast<std::uint64_t>(header.number), bytes.subspan(4, 8));
  put_big_endian(static_cast<std::uint64_t>(header.time_us), bytes.subspan(12, 8));
  put_big_endian(static_cast<std::uint32_t>(header.channel_bytes), bytes.subspan(20, 4));
  put_big_endian(static_cast<std::uint32_t>(header.data_bytes), bytes.subspan(24, 4));
}

LogEvent whole_event(std::span<const std::uint8_t> bytes) {
  const LogHeader header = read_header(bytes);
  const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
  const auto content = bytes.subspan(header_bytes);
  return {.number = header.number,
          .time_us = header.time_us,
          .channel = {reinterpret_cast<const char*>(content.data()), channel_bytes},
          .data = content.subspan(channel_bytes)};
}

std::optional<std::string> implausible(const LogHeader& header) {
  if (header.sync != sync_word) return "no event begins here";
  if (header.channel_bytes < 1 || header.channel_bytes > maximum_channel_bytes) {
    return "a channel name of " + std::to_string(header.channel_bytes) + " bytes";
  }
  if (header.data_bytes < 0 || header.data_bytes > maximum_data_bytes) {
    return "data of " + std::to_string(header.data_bytes) + " bytes";
  }
  return std::nullopt;
}

bool begins_with_sync(std::span<const std::uint8_t> bytes) {
  return std::equal(bytes.begin(), bytes.begin() + std::min(std::ssize(bytes), 4L),
                    sync_bytes.begin());
}

bool begins_nearly_with_sync(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 &&
         std::popcount(static_cast<std::uint32_t>(big_endian(bytes.first(4))) ^ sync_word) <= 8;
}

std::size_t find_sync(std::span<const std::uint8_t> bytes, std::size_t from) {
  const auto rest = bytes.subspan(std::min(from, bytes.size()));
  const auto found = std::search(rest.begin(), rest.end(), sync_bytes.begin(), sync_bytes.end());
  return static_cast<std::size_t>(found - rest.begin()) + bytes.size() - rest.size();
}

}  // namespace maploop::lcm_log
