#include "sensors/imu/xsens.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace maploop::sensors {
namespace {

using XsensBytes = std::span<const std::uint8_t>;

constexpr std::uint8_t xsens_preamble = 0xfa, xsens_bus = 0xff, mt_data2 = 0x36;
constexpr std::uint8_t xsens_long = 0xff;  // the length is in the next two bytes

// Reads bytes in big-endian order.
std::uint64_t big_endian(XsensBytes bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t b : bytes) value = value << 8 | b;
  return value;
}

// Reads three numbers in the format that the lowest two bits of the identifier select. Returns
// nothing if one is larger than `most`.
std::optional<std::array<double, 3>> three_numbers(unsigned format, XsensBytes data, double most) {
  constexpr std::array<std::size_t, 4> widths{4, 4, 6, 8};  // float, 12.20, 16.32, double
  const std::size_t width = widths[format & 3U];
  if (data.size() != 3 * width) return {};
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const XsensBytes one = data.subspan(i * width, width);
    switch (format & 3U) {
      case 0:
        values[i] = std::bit_cast<float>(static_cast<std::uint32_t>(big_endian(one)));
        break;
      case 1:
        values[i] = std::ldexp(static_cast<std::int32_t>(big_endian(one)), -20);
        break;
      case 2:  // the fraction comes first
        values[i] = static_cast<std::int16_t>(big_endian(one.last(2))) +
                    std::ldexp(static_cast<double>(big_endian(one.first(4))), -32);
        break;
      default:
        values[i] = std::bit_cast<double>(big_endian(one));
    }
    if (!(std::abs(values[i]) <= most)) return {};
  }
  return values;
}

}  // namespace

void XsensDecoder::drop(std::size_t count) {
  std::copy(message_.begin() + static_cast<std::ptrdiff_t>(count),
            message_.begin() + static_cast<std::ptrdiff_t>(size_), message_.begin());
  size_ -= count;
}

std::optional<XsensSample> XsensDecoder::decode(std::span<const std::uint8_t> data) {
  constexpr unsigned sample_time_fine = 0x1060, acceleration = 0x4020, rate_of_turn = 0x8020;
  constexpr unsigned format_bits = 0xf;
  constexpr double max_force = 500.0, max_rate = 100.0;  // m/s^2, rad/s
  std::optional<std::uint32_t> ticks;
  std::optional<std::array<double, 3>> force, rate;
  while (data.size() >= 3) {
    const auto id = static_cast<unsigned>(big_endian(data.first(2)));
    const std::size_t size = data[2];
    if (data.size() < 3 + size) return {};
    const auto value = data.subspan(3, size);
    const unsigned what = id & ~format_bits;
    if (what == sample_time_fine && size == 4)
      ticks = static_cast<std::uint32_t>(big_endian(value));
    if (what == acceleration) force = three_numbers(id, value, max_force);
    if (what == rate_of_turn) rate = three_numbers(id, value, max_rate);
    data = data.subspan(3 + size);
  }
  if (!ticks || !force || !rate) return {};
  // The 32 bits wrap after 5 days; a unit that was switched on again looks the same.
  if (last_ticks_) ticks_ += static_cast<std::uint32_t>(*ticks - *last_ticks_);
  last_ticks_ = ticks;
  return XsensSample{ticks_ * Duration(std::chrono::microseconds(100)), *force, *rate};
}

// Parses the message at the start of the buffer. Returns true with a sample; otherwise bytes that
// cannot be a message are dropped.
bool XsensDecoder::take_message(XsensSample& sample) {
  for (;;) {
    const auto end = message_.begin() + static_cast<std::ptrdiff_t>(size_);
    drop(static_cast<std::size_t>(std::find(message_.begin(), end, xsens_preamble) -
                                  message_.begin()));
    if (size_ < 4) return false;
    const bool is_long = message_[3] == xsens_long;
    if (is_long && size_ < 6) return false;
    const std::size_t head = is_long ? 6 : 4;
    const std::size_t length =
        is_long ? big_endian(XsensBytes(message_).subspan(4, 2)) : message_[3];
    const std::size_t size = head + length + 1;
    const bool possible = message_[1] == xsens_bus && size <= longest;
    if (possible && size_ < size) return false;
    unsigned sum = 0;
    for (std::size_t i = 1; possible && i < size; ++i) sum += message_[i];
    if (!possible || (sum & 0xffU) != 0) {
      ++counts_.damaged;
      drop(1);
      continue;
    }
    ++counts_.messages;
    const bool has_data = message_[2] == mt_data2;
    const auto found = has_data ? decode(XsensBytes(message_).subspan(head, length))
                                : std::optional<XsensSample>{};
    drop(size);
    if (found) {
      sample = *found;
      return true;
    }
    if (has_data) ++counts_.incomplete;
  }
}

bool XsensDecoder::next(std::span<const std::uint8_t>& bytes, XsensSample& sample) {
  for (;;) {
    if (take_message(sample)) return true;
    if (bytes.empty()) return false;
    const std::size_t count = std::min(bytes.size(), longest - size_);
    std::copy_n(bytes.begin(), count, message_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += count;
    bytes = bytes.subspan(count);
  }
}

}  // namespace maploop::sensors
