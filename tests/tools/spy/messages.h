// Encodes messages for the tests of the spy.
#pragma once

#include <cstdint>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"

namespace maploop::spy {

using schema::encoded;
using schema::own_schema;

inline std::vector<std::uint8_t> imu(std::uint64_t sequence, Time stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  sample.sequence = sequence;
  sample.yaw_rate = 0.25;
  return encoded(to_lcm(sample));
}

}  // namespace maploop::spy
