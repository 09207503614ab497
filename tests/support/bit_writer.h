// A BitWriter writes the bits of a message, the highest first.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ppp/readers/files/broadcast_fields.h"

namespace maploop::testing {

struct BitWriter {
  std::vector<bool> all;

  // Beyond 64 bits there are zeros in front.
  BitWriter& put(std::uint64_t value, std::size_t bits) {
    for (std::size_t i = bits; i-- > 0;) all.push_back(i < 64 && (value >> i & 1U) != 0);
    return *this;
  }
  // Writes value / unit, rounded, in two's complement.
  BitWriter& put(double value, double unit, std::size_t bits) {
    return put(static_cast<std::uint64_t>(std::llround(value / unit)), bits);
  }
  BitWriter& put(std::span<const ppp::BroadcastField> fields, const ppp::BroadcastValues& values) {
    for (const ppp::BroadcastField& f : fields) {
      const auto bits = static_cast<std::size_t>(f.bits);
      if (f.what == ppp::Quantity::none) {
        all.insert(all.end(), bits, false);
        continue;
      }
      const double units = std::round(values[static_cast<std::size_t>(f.what)] / f.unit);
      if (f.coding == ppp::Coding::sign_and_magnitude) {
        put(units < 0.0 ? 1 : 0, 1);
        put(static_cast<std::uint64_t>(std::abs(units)), bits - 1);
      } else {
        put(static_cast<std::uint64_t>(static_cast<std::int64_t>(units)), bits);
      }
    }
    return *this;
  }
  void fill(std::size_t size) { all.resize(size); }
  // Bits beyond the end are zeros.
  std::uint64_t number(std::size_t at, std::size_t bits) const {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + bits; ++i) value = value << 1 | (i < all.size() && all[i]);
    return value;
  }
  std::string bytes() const {
    std::string text;
    for (std::size_t i = 0; i < all.size(); i += 8) text += static_cast<char>(number(i, 8));
    return text;
  }
};

}  // namespace maploop::testing
