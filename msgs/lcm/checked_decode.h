// A message of one of our own types, from bytes that anybody may have sent.
#pragma once

#include <cstdint>
#include <span>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/schema.h"

namespace maploop::schema {

// The types of msgs/lcm, which are part of the program.
inline const Schema& own_schema() {
  static const Schema schema(own_types());
  return schema;
}

// False where the bytes are no message of this type. The schema looks first: LCM's own code takes
// the sizes in a message at their word. `schema` knows our types.
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
