// This file encodes NCOM as an OXTS unit sends it: the inverse of ncom.h.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "sensors/imu/ncom.h"

namespace maploop::sensors {

using NcomBytes = std::array<std::uint8_t, ncom_size>;

// Makes a packet of a unit whose status is locked. Values are rounded to 1e-4 m/s^2 and 1e-5 rad/s.
// NCOM has no way to leave out an axis: one that is not measured is at rest and level.
inline NcomBytes ncom_packet(std::uint16_t minute_ms, const InertialValues& values) {
  NcomBytes bytes{};
  const auto put_i24 = [&bytes](std::size_t at, double value) {
    const auto v = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value)));
    for (std::size_t i = 0; i < 3; ++i) bytes[at + i] = static_cast<std::uint8_t>(v >> 8 * i);
  };
  bytes[0] = 0xe7;
  bytes[1] = static_cast<std::uint8_t>(minute_ms);
  bytes[2] = static_cast<std::uint8_t>(minute_ms >> 8);
  put_i24(3, values.specific_force_forward * 1e4);
  put_i24(6, -values.specific_force_left * 1e4);
  put_i24(9, -(values.six_axes ? values.specific_force_up : 9.81) * 1e4);
  put_i24(12, values.roll_rate * 1e5);
  put_i24(15, -values.pitch_rate * 1e5);
  put_i24(18, -values.yaw_rate * 1e5);
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
