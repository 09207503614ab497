// This file decodes messages of our own types from untrusted bytes.
#pragma once

#include <cstdint>
#include <span>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/schema.h"

namespace maploop::schema {

// Returns the types of msgs/lcm, which are part of the program.
inline const Schema& own_schema() {
  static const Schema schema(own_types());
  return schema;
}

// Returns false if the bytes are not a message of this type. They are checked against the schema
// first, because LCM's own code trusts the sizes in a message. `schema` must contain our types.
template <class Message>
bool checked_decode(const Schema& schema, std::span<const std::uint8_t> data, Message& message) {
  const Type* type = schema.find(fingerprint_of(data));
  DecodedMessage checked;
  return type != nullptr && type->fingerprint == static_cast<std::uint64_t>(Message::getHash()) &&
         !checked.decode(*type, data) &&
         message.decode(data.data(), 0, static_cast<int>(data.size())) ==
             static_cast<int>(data.size());
}

}  // namespace maploop::schema
