// Encodes messages for the tests of the spy.
#pragma once

#include <cstdint>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/schema.h"

namespace maploop::spy {

inline const schema::Schema& own_schema() {
  static const schema::Schema schema(schema::own_types());
  return schema;
}

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

inline std::vector<std::uint8_t> imu(std::uint64_t sequence, Time stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  sample.sequence = sequence;
  sample.yaw_rate = 0.25;
  return encoded(to_lcm(sample));
}

}  // namespace maploop::spy
