// This file computes LCM's fingerprint of a type ("LCM type specification", section Fingerprint
// computation): a hash of the members' names, primitive types and dimensions, plus those of the
// nested types, where a type that contains itself counts as 0, rotated left by one bit.
#include <stdexcept>

#include "msgs/lcm/schema.h"

namespace maploop::schema {
namespace {

// The sum visits a nested type as often as it is named, which doubles with every level.
constexpr int kMaximumVisits = 10'000;

// LCM hashes in signed arithmetic, so the shift to the right repeats the sign.
std::uint64_t update(std::uint64_t hash, std::int8_t c) {
  const auto shifted = static_cast<std::uint64_t>(static_cast<std::int64_t>(hash) >> 55);
  return ((hash << 8) ^ shifted) + static_cast<std::uint64_t>(static_cast<std::int64_t>(c));
}

std::uint64_t update(std::uint64_t hash, std::string_view text) {
  hash = update(hash, static_cast<std::int8_t>(text.size()));
  for (const char c : text) hash = update(hash, static_cast<std::int8_t>(c));
  return hash;
}

std::uint64_t hash_of_members(const Type& type) {
  std::uint64_t hash = 0x12345678;
  for (const Member& member : type.members) {
    hash = update(hash, member.name);
    if (member.kind != Kind::structure) hash = update(hash, member.type_name);
    hash = update(hash, static_cast<std::int8_t>(member.dimensions.size()));
    for (const Dimension& dimension : member.dimensions) {
      const bool variable = dimension.size == 0;
      hash = update(hash, static_cast<std::int8_t>(variable ? 1 : 0));
      hash = update(hash, dimension.text);
    }
  }
  return hash;
}

struct Inside {  // the types that contain the current one
  const Type* type;
  const Inside* outer;
};

std::uint64_t recursive_hash(const Type& type, const Inside* outer, int& visits) {
  for (const Inside* i = outer; i != nullptr; i = i->outer) {
    if (i->type == &type) return 0;
  }
  if (++visits > kMaximumVisits) {
    throw std::runtime_error("the type '" + type.name + "' is nested too deeply: more than " +
                             std::to_string(kMaximumVisits) + " types inside each other");
  }
  const Inside here{&type, outer};
  std::uint64_t hash = hash_of_members(type);
  for (const Member& member : type.members) {
    if (member.kind == Kind::structure) hash += recursive_hash(*member.type, &here, visits);
  }
  return (hash << 1) + (hash >> 63);
}

}  // namespace

std::uint64_t fingerprint_of(const Type& type) {
  int visits = 0;
  return recursive_hash(type, nullptr, visits);
}

std::uint64_t fingerprint_of(std::span<const std::uint8_t> message) {
  if (message.size() < 8) return 0;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = value << 8 | message[i];
  return value;
}

}  // namespace maploop::schema
