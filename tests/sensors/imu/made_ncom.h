// NCOM packets with given values.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "sensors/imu/ncom.h"

namespace maploop::sensors {

using NcomBytes = std::array<std::uint8_t, ncom_size>;

inline void put_i24(NcomBytes& bytes, std::size_t at, double value) {
  const auto v = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value)));
  for (std::size_t i = 0; i < 3; ++i) bytes[at + i] = static_cast<std::uint8_t>(v >> 8 * i);
}

// As a locked unit sends it: m/s^2, rad/s; axes forward, left, up.
inline NcomBytes ncom_packet(std::uint16_t minute_ms, double forward, double left,
                             double yaw_rate) {
  NcomBytes bytes{};
  bytes[0] = 0xe7;
  bytes[1] = static_cast<std::uint8_t>(minute_ms);
  bytes[2] = static_cast<std::uint8_t>(minute_ms >> 8);
  put_i24(bytes, 3, forward * 1e4);
  put_i24(bytes, 6, -left * 1e4);
  put_i24(bytes, 9, -9.81 * 1e4);
  put_i24(bytes, 18, -yaw_rate * 1e5);
  bytes[21] = 4;
  unsigned sum = 0;
  for (std::size_t i = 1; i < 71; ++i) {
    if (i == 22 || i == 61) bytes[i] = static_cast<std::uint8_t>(sum);
    sum += bytes[i];
  }
  bytes[71] = static_cast<std::uint8_t>(sum);
  return bytes;
}

}  // namespace maploop::sensors
