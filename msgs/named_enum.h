// This file handles enumerations with a function names_of(value) beside them, which lists the names
// of their values.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <type_traits>

namespace maploop {

template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires(Enum value) {
  names_of(value);
};

template <NamedEnum Enum>
constexpr std::string_view name_of(Enum value) {
  const auto names = names_of(value);
  const auto i = static_cast<std::size_t>(value);
  return i < names.size() ? names[i] : "unknown";
}

template <NamedEnum Enum>
constexpr std::optional<Enum> value_named(std::string_view name) {
  const auto names = names_of(Enum{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace maploop
