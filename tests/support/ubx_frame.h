// Makes UBX frames.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace maploop::testing {

inline std::string ubx_frame(std::uint8_t message_class, std::uint8_t id,
                             std::string_view payload) {
  std::string checked{static_cast<char>(message_class), static_cast<char>(id),
                      static_cast<char>(payload.size() & 0xff),
                      static_cast<char>(payload.size() >> 8)};
  checked += payload;
  std::uint8_t a = 0, b = 0;
  for (const char c : checked) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return "\xb5\x62" + checked + static_cast<char>(a) + static_cast<char>(b);
}

// Returns the bytes of a number in memory, whose order is that of UBX.
template <class T>
std::string raw_bytes(T value) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, sizeof value);
  return text;
}

}  // namespace maploop::testing
