// This file makes the packets of a scanner that stands in a round room.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "sensors/velodyne/data_packet.h"
#include "sensors/velodyne/position_packet.h"

namespace maploop::sensors {

using DataBytes = std::array<std::uint8_t, velodyne_data_size>;
using PositionBytes = std::array<std::uint8_t, velodyne_position_size>;

inline void put(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t value,
                std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

// Makes blocks `step` hundredths of a degree apart from `azimuth` on, with every return at `range`
// (2 mm).
inline DataBytes data_packet(double azimuth, double step, std::uint32_t device_time,
                             std::uint16_t range = 5000, std::uint8_t mode = 0x37,
                             std::uint8_t product = 0x22) {
  DataBytes bytes{};
  for (std::size_t block = 0; block < velodyne_blocks; ++block) {
    const std::size_t firing = mode == 0x39 ? block / 2 : block;
    const double at = azimuth + step * static_cast<double>(firing);
    put(bytes, 100 * block, 0xeeff, 2);
    put(bytes, 100 * block + 2, static_cast<std::uint64_t>(at + 0.5) % velodyne_full_turn, 2);
    for (std::size_t i = 0; i < velodyne_block_returns; ++i) {
      put(bytes, 100 * block + 4 + 3 * i, range, 2);
      bytes[100 * block + 6 + 3 * i] = 100;
    }
  }
  put(bytes, 1200, device_time, 4);
  bytes[1204] = mode;
  bytes[1205] = product;
  return bytes;
}

inline PositionBytes position_packet(std::uint32_t device_time, std::uint8_t pulse,
                                     std::string_view sentence) {
  PositionBytes bytes{};
  put(bytes, 198, device_time, 4);
  bytes[202] = pulse;
  std::memcpy(bytes.data() + 206, sentence.data(), sentence.size());
  return bytes;
}

}  // namespace maploop::sensors
