// This file takes little-endian fields from the bytes of a recording, one after the other.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::sensors::bag {

using Bytes = std::span<const std::uint8_t>;

// Says that a part of a recording cannot be what it should be.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline std::string_view as_text(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Throws Malformed if fewer bytes are left than a field has.
class ByteCursor {
 public:
  explicit ByteCursor(Bytes bytes) : left_(bytes) {}

  template <std::unsigned_integral Number>
  Number number() {
    static_assert(std::endian::native == std::endian::little);
    Number value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  Bytes bytes(std::uint64_t count) {
    if (count > left_.size()) {
      throw Malformed("a field of " + std::to_string(count) + " bytes is followed by only " +
                      std::to_string(left_.size()));
    }
    const Bytes taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  Bytes block() { return bytes(number<std::uint32_t>()); }  // after its length
  std::string_view text() { return as_text(block()); }
  Bytes rest() const { return left_; }

 private:
  Bytes left_;
};

// Returns nanoseconds since 1970 as a time. Throws Malformed if it is later than the year 2200.
inline Time checked_time(std::uint64_t nanoseconds) {
  constexpr std::uint64_t year_2200 = 7'258'118'400'000'000'000;
  if (nanoseconds > year_2200) {
    throw Malformed(std::to_string(nanoseconds) +
                    " ns since 1970 are not a time between 1970 and 2200");
  }
  return from_nanoseconds(static_cast<std::int64_t>(nanoseconds));
}

}  // namespace maploop::sensors::bag
