#include "runtime/core/trace_text.h"

#include <algorithm>
#include <cstddef>

namespace maploop::runtime {
namespace {

// Returns the bytes of the well-formed UTF-8 sequence that `text` starts with; 0 if there is none
// (Unicode 15, table 3-7). Precondition: text is not empty.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto continues = [&](std::size_t i, unsigned lowest = 0x80, unsigned highest = 0xbf) {
    return byte(i) >= lowest && byte(i) <= highest;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return continues(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    // The sequence is neither overlong nor a surrogate.
    const bool second = continues(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf);
    return second && continues(2) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const bool second = continues(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf);
    return second && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

void append_escaped(std::string& text, char c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto code = static_cast<unsigned char>(c);
  if (c == '"' || c == '\\') {
    text += '\\';
    text += c;
  } else if (code < 0x20 || code == 0x7f) {
    text += "\\u00";
    text += kDigits[code >> 4];
    text += kDigits[code & 0xf];
  } else {
    text += c;
  }
}

}  // namespace

void append_json(std::string& text, std::string_view value) {
  text += '"';
  while (!value.empty()) {
    const std::size_t length = utf8_length(value);
    if (length == 0) {
      text += "\\ufffd";
    } else if (length == 1) {
      append_escaped(text, value.front());
    } else {
      text += value.substr(0, length);
    }
    value.remove_prefix(std::max<std::size_t>(length, 1));
  }
  text += '"';
}

void append_hexadecimal(std::string& text, std::uint64_t value) {
  std::array<char, 16> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr);
}

void append_microseconds(std::string& text, Duration value) {
  const std::int64_t ns = value.count();
  append_number(text, ns / 1000);
  const std::int64_t rest = ns % 1000;
  text += '.';
  text += static_cast<char>('0' + rest / 100);
  text += static_cast<char>('0' + rest / 10 % 10);
  text += static_cast<char>('0' + rest % 10);
}

}  // namespace maploop::runtime
