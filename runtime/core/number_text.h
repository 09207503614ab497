// This file writes a number as text that reads back as the same number.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace maploop::runtime {

// Uses as few digits as possible.
inline std::string shortest_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace maploop::runtime
