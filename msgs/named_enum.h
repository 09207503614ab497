// This file handles enumerations with a function names_of(value) beside them, which lists the names
// of their values, numbered from 0.
//
//   enum class Source { visual, lidar };
//   constexpr auto names_of(Source) { return names_up_to<Source::lidar>({"visual", "lidar"}); }
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace maploop {

// Returns the names of an enumeration; there must be one for each value up to `last`.
template <auto last, std::size_t n>
constexpr std::array<std::string_view, n> names_up_to(const std::string_view (&names)[n]) {
  static_assert(n == static_cast<std::size_t>(last) + 1, "each value has one name");
  return std::to_array(names);
}

// This is an enumeration with a function names_of().
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires(Enum value) {
  names_of(value);
};

// The names of an enumeration's values, in the order of the values.
template <NamedEnum Enum>
inline constexpr auto enum_names = names_of(Enum{});

// The number of an enumeration's values.
template <NamedEnum Enum>
inline constexpr std::size_t count_of = enum_names<Enum>.size();

// Returns "unknown" for a value without a name.
template <NamedEnum Enum>
constexpr std::string_view to_string(Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < count_of<Enum> ? enum_names<Enum>[i] : "unknown";
}

// Does the reverse of to_string(); returns nothing if no value has that name.
template <NamedEnum Enum>
constexpr std::optional<Enum> value_named(std::string_view name) {
  for (std::size_t i = 0; i < count_of<Enum>; ++i) {
    if (enum_names<Enum>[i] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace maploop
