#include "msgs/lcm/schema.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace maploop::schema {
namespace {

// The fingerprint is a sum that visits a nested type as often as it is named, which doubles with
// every level.
constexpr int maximum_visits = 10'000;

// LCM hashes in signed arithmetic, so the shift to the right repeats the sign.
void update(std::uint64_t& hash, std::size_t number) {
  const auto shifted = static_cast<std::uint64_t>(static_cast<std::int64_t>(hash) >> 55);
  const auto byte = static_cast<std::int8_t>(number);
  hash = ((hash << 8) ^ shifted) + static_cast<std::uint64_t>(std::int64_t{byte});
}

void update(std::uint64_t& hash, std::string_view text) {
  update(hash, text.size());
  for (const char c : text) update(hash, static_cast<std::size_t>(c));
}

struct Inside {  // the types that contain the current one
  const Type* type;
  const Inside* outer;
};

// Returns LCM's fingerprint of a type ("LCM type specification", section Fingerprint computation):
// a hash of the members' names, primitive types and dimensions, plus those of the nested types,
// where a type that contains itself counts as 0, rotated left by one bit.
std::uint64_t fingerprint(const Type& type, const Inside* outer, int& visits) {
  for (const Inside* i = outer; i != nullptr; i = i->outer) {
    if (i->type == &type) return 0;
  }
  if (++visits > maximum_visits) {
    throw std::runtime_error(type.where + "the type '" + type.name +
                             "' is nested too deeply: more than " + std::to_string(maximum_visits) +
                             " types inside each other");
  }
  std::uint64_t hash = 0x12345678;
  for (const Member& member : type.members) {
    update(hash, member.name);
    if (member.kind != Kind::structure) update(hash, member.type_name);
    update(hash, member.dimensions.size());
    for (const Dimension& dimension : member.dimensions) {
      update(hash, dimension.size == 0 ? 1 : 0);
      update(hash, dimension.text);
    }
  }
  const Inside here{&type, outer};
  for (const Member& member : type.members) {
    if (member.kind == Kind::structure) hash += fingerprint(*member.type, &here, visits);
  }
  return (hash << 1) + (hash >> 63);
}

}  // namespace

std::size_t encoded_size(Kind kind) {
  constexpr std::array<std::size_t, 10> sizes{1, 2, 4, 8, 1, 1, 4, 8, 0, 0};
  return sizes[static_cast<std::size_t>(kind)];
}

Schema::Schema(std::span<const TypeText> texts) {
  for (const TypeText& text : texts) {
    for (auto& type : parse_types(text)) types_.push_back(std::move(type));
  }
  std::unordered_map<std::string_view, const Type*> named;
  for (const auto& type : types_) named.emplace(type->name, type.get());
  for (const auto& type : types_) {
    for (Member& member : type->members) {
      if (member.kind != Kind::structure) continue;
      const auto found = named.find(member.type_name);
      if (found == named.end()) {
        throw std::runtime_error(member.where + "the type '" + member.type_name +
                                 "' is not known: give the file that declares it too");
      }
      member.type = found->second;
    }
  }
  for (const auto& type : types_) {
    int visits = 0;
    type->fingerprint = fingerprint(*type, nullptr, visits);
    by_fingerprint_.emplace(type->fingerprint, type.get());
  }
  // The first of equal declarations stays.
  std::erase_if(types_, [&](const auto& type) {
    const Type* first = named.at(type->name);
    if (first->fingerprint != type->fingerprint) {
      throw std::runtime_error(type->where + "the type '" + type->name +
                               "' is declared differently elsewhere: leave one of them out");
    }
    return first != type.get();
  });
}

const Type* Schema::find(std::uint64_t fingerprint) const {
  const auto found = by_fingerprint_.find(fingerprint);
  return found == by_fingerprint_.end() ? nullptr : found->second;
}

const Type* Schema::find(std::string_view name) const {
  const auto found = std::find_if(types_.begin(), types_.end(),
                                  [&](const auto& type) { return type->name == name; });
  return found == types_.end() ? nullptr : found->get();
}

std::uint64_t fingerprint_of(std::span<const std::uint8_t> message) {
  if (message.size() < 8) return 0;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = value << 8 | message[i];
  return value;
}

}  // namespace maploop::schema
