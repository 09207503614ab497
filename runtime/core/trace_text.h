// This file appends pieces of JSON to a text that keeps its memory.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::runtime {

// Appends a JSON string (RFC 8259) with its quotation marks. Bytes that are not UTF-8 become
// U+FFFD, one by one.
void append_json(std::string& text, std::string_view value);

// Appends the shortest form that reads back as the same number; a double must be finite to be JSON.
template <class Number>
requires std::integral<Number> || std::floating_point<Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// Appends the number without 0x.
void append_hexadecimal(std::string& text, std::uint64_t value);

// Appends the value in microseconds, with three decimals. Precondition: it is not negative.
void append_microseconds(std::string& text, Duration value);

}  // namespace maploop::runtime
