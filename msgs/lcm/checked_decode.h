// This file encodes messages, and decodes those of our own types from untrusted bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/schema.h"

namespace maploop::schema {

// Returns the types of msgs/lcm, which are part of the program.
inline const Schema& own_schema() {
  static const Schema schema(own_types());
  return schema;
}

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// Returns false if the bytes are not a message of this type. They are checked against the schema
// first, because LCM's own code trusts the sizes in a message. `schema` must contain our types.
template <class Message>
bool checked_decode(const Schema& schema, std::span<const std::uint8_t> data, Message& message) {
  const int size = static_cast<int>(data.size());
  return fingerprint_of(data) == static_cast<std::uint64_t>(Message::getHash()) &&
         try_decode(schema, data) && message.decode(data.data(), 0, size) == size;
}

}  // namespace maploop::schema
