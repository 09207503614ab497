// Pieces of JSON, appended to a text that keeps its memory.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::runtime {

// A JSON string (RFC 8259) with its quotation marks. What is not UTF-8 becomes U+FFFD, byte by
// byte.
void append_json(std::string& text, std::string_view value);

// Shortest form that reads back as the same number; a double must be finite to be JSON.
template <class Number>
requires std::integral<Number> || std::floating_point<Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// Without 0x.
void append_hexadecimal(std::string& text, std::uint64_t value);

// In microseconds, with three decimals. Precondition: not negative.
void append_microseconds(std::string& text, Duration value);

}  // namespace maploop::runtime
