#include "ppp/readers/streams/rtcm3_frames.h"

#include <array>

namespace maploop::ppp {
namespace {

constexpr char preamble = '\xd3';

}  // namespace

// This is CRC-24Q (RTCM 10403, section 4.2).
std::uint32_t crc24q(std::string_view bytes) {
  static constexpr auto table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t crc = i << 16;
      for (int bit = 0; bit < 8; ++bit)
        crc = (crc << 1) ^ ((crc & 0x800000U) != 0 ? 0x1864cfbU : 0);
      t[i] = crc & 0xffffffU;
    }
    return t;
  }();
  std::uint32_t crc = 0;
  for (const char c : bytes) {
    crc = ((crc << 8) & 0xffffffU) ^ table[(crc >> 16) ^ static_cast<std::uint8_t>(c)];
  }
  return crc;
}

bool Rtcm3Frames::next(Rtcm3Message& message) {
  constexpr std::size_t head = 3, tail = 3;
  while (at_ < bytes_.size()) {
    at_ = bytes_.find(preamble, at_);
    if (at_ == std::string_view::npos) break;
    Rtcm3Bits frame(bytes_.substr(at_));
    if (more_follow_ && bytes_.size() - at_ < head) return false;
    frame.skip(8);
    const bool reserved_clear = frame.number(6) == 0;
    const std::size_t length = frame.number(10), size = head + length + tail;
    if (reserved_clear) {
      if (more_follow_ && bytes_.size() - at_ < size) return false;
      const std::string_view whole = bytes_.substr(at_, size);
      if (whole.size() == size && length >= 2 &&
          Rtcm3Bits(whole.substr(head + length)).number(24) ==
              crc24q(whole.substr(0, head + length))) {
        message.payload = whole.substr(head, length);
        message.number = static_cast<int>(Rtcm3Bits(message.payload).number(12));
        message.offset = at_;
        at_ += size;
        return true;
      }
      ++damaged_;
    }
    ++at_;
  }
  at_ = bytes_.size();
  return false;
}

std::uint64_t Rtcm3Bits::number(std::size_t bits) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bits; ++i, ++at_) {
    const std::size_t byte = at_ / 8;
    const unsigned set =
        byte < payload_.size()
            ? static_cast<unsigned>(static_cast<std::uint8_t>(payload_[byte]) >> (7 - at_ % 8)) & 1U
            : 0U;
    value = value << 1 | set;
  }
  return value;
}

std::int64_t Rtcm3Bits::signed_number(std::size_t bits) {
  const std::uint64_t value = number(bits);
  const bool negative = (value >> (bits - 1) & 1U) != 0;
  return static_cast<std::int64_t>(negative ? value | ~std::uint64_t{0} << bits : value);
}

}  // namespace maploop::ppp
