#include "msgs/lcm/schema.h"

#include <algorithm>
#include <stdexcept>

#include "msgs/lcm/schema_parser.h"

namespace maploop::schema {
namespace {

using Named = std::unordered_map<std::string_view, Type*>;

std::string place(const ParsedType& parsed, int line) {
  return parsed.source + ":" + std::to_string(line) + ": ";
}

void resolve(Type& type, const ParsedType& parsed, const Named& named) {
  for (std::size_t i = 0; i < type.members.size(); ++i) {
    Member& member = type.members[i];
    if (member.kind != Kind::structure) continue;
    const auto found = named.find(member.type_name);
    if (found == named.end()) {
      throw std::runtime_error(place(parsed, parsed.member_lines[i]) + "the type '" +
                               member.type_name +
                               "' is not known: give the file that declares it too");
    }
    member.type = found->second;
  }
}

bool same_dimensions(const Member& a, const Member& b) {
  return std::equal(a.dimensions.begin(), a.dimensions.end(), b.dimensions.begin(),
                    b.dimensions.end(),
                    [](const Dimension& x, const Dimension& y) { return x.text == y.text; });
}

bool same_declaration(const Type& a, const Type& b) {
  return std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                    [](const Member& x, const Member& y) {
                      return x.name == y.name && x.type_name == y.type_name &&
                             same_dimensions(x, y);
                    });
}

}  // namespace

std::size_t encoded_size(Kind kind) {
  switch (kind) {
    case Kind::int8:
    case Kind::byte:
    case Kind::boolean:
      return 1;
    case Kind::int16:
      return 2;
    case Kind::int32:
    case Kind::float32:
      return 4;
    case Kind::int64:
    case Kind::float64:
      return 8;
    case Kind::string:
    case Kind::structure:
      break;
  }
  return 0;
}

Schema::Schema(std::span<const TypeText> texts) {
  std::vector<ParsedType> parsed;
  for (const TypeText& text : texts) {
    for (ParsedType& type : parse_types(text)) parsed.push_back(std::move(type));
  }
  Named named;
  std::vector<std::pair<std::unique_ptr<Type>, const ParsedType*>> kept;
  for (const ParsedType& candidate : parsed) {
    if (const auto same = named.find(candidate.type.name); same != named.end()) {
      if (same_declaration(*same->second, candidate.type)) continue;
      throw std::runtime_error(place(candidate, candidate.line) + "the type '" +
                               candidate.type.name +
                               "' is declared differently elsewhere: leave one of them out");
    }
    kept.emplace_back(std::make_unique<Type>(candidate.type), &candidate);
    named.emplace(kept.back().first->name, kept.back().first.get());
  }
  for (auto& [type, origin] : kept) resolve(*type, *origin, named);
  for (auto& [type, origin] : kept) {
    type->fingerprint = fingerprint_of(*type);
    by_fingerprint_.emplace(type->fingerprint, type.get());
    types_.push_back(std::move(type));
  }
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

}  // namespace maploop::schema
