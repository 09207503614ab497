#include "ppp/readers/ubx_frames.h"

namespace maploop::ppp {
namespace {

// Fletcher's checksum of class, id, length and payload (u-blox interface description, "UBX
// checksum").
bool sound(std::string_view checked, std::string_view sum) {
  std::uint8_t a = 0, b = 0;
  for (const char c : checked) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return a == static_cast<std::uint8_t>(sum[0]) && b == static_cast<std::uint8_t>(sum[1]);
}

}  // namespace

bool UbxFrames::next(UbxFrame& frame) {
  constexpr std::size_t head = 6, tail = 2;
  while (at_ < bytes_.size()) {
    const std::size_t sync = bytes_.find("\xb5\x62", at_);
    const std::size_t begin = sync == std::string_view::npos ? bytes_.size() : sync;
    others_ += begin - at_;
    at_ = begin;
    const std::string_view rest = bytes_.substr(begin);
    if (rest.empty()) return false;
    if (rest.size() >= head + tail) {
      const std::size_t length = ubx_number<std::uint16_t>(rest, 4);
      const std::size_t size = head + length + tail;
      if (size <= rest.size() &&
          sound(rest.substr(2, head - 2 + length), rest.substr(head + length, tail))) {
        frame.message_class = static_cast<std::uint8_t>(rest[2]);
        frame.id = static_cast<std::uint8_t>(rest[3]);
        frame.payload = rest.substr(head, length);
        frame.offset = begin;
        at_ = begin + size;
        return true;
      }
    }
    ++damaged_;
    ++others_;
    ++at_;
  }
  return false;
}

}  // namespace maploop::ppp
