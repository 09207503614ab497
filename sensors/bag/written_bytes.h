// This file has what the writers of recordings write: numbers and texts, little endian.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::sensors::bag {

static_assert(std::endian::native == std::endian::little, "bags and MCAP files are little endian");

template <class Number>
std::string number(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// A text, or any bytes, behind its length.
inline std::string text(std::string_view value) {
  return number(static_cast<std::uint32_t>(value.size())).append(value);
}

}  // namespace maploop::sensors::bag
