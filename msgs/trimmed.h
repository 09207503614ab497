// This file removes blanks around a text.
#pragma once

#include <string_view>

namespace maploop {

constexpr std::string_view white_space = " \t\r\n\v\f";

inline std::string_view trimmed(std::string_view text, std::string_view blanks = white_space) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace maploop
