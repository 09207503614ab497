#include "ppp/readers/streams/ubx_frames.h"

#include <array>

namespace maploop::ppp {
namespace {

// Checks Fletcher's checksum of class, id, length and payload (u-blox interface description, "UBX
// checksum").
bool sound(std::string_view checked, std::string_view sum) {
  std::uint8_t a = 0, b = 0;
  for (const char c : checked) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return a == static_cast<std::uint8_t>(sum[0]) && b == static_cast<std::uint8_t>(sum[1]);
}

constexpr std::size_t ubx_head = 6, ubx_tail = 2;

// Returns whether a frame is complete or cannot be valid: RAWX, the longest one, has 8176 bytes.
bool ubx_whole(std::string_view rest) {
  constexpr std::size_t longest_payload = 8192;
  if (rest.size() < ubx_head) return false;
  const std::size_t length = ubx_number<std::uint16_t>(rest, 4);
  return length > longest_payload || rest.size() >= ubx_head + length + ubx_tail;
}

}  // namespace

std::optional<Satellite> ubx_satellite(std::uint8_t gnss, std::uint8_t number) {
  constexpr std::array<System, 8> systems{System::gps,     System::sbas, System::galileo,
                                          System::beidou,  System::gps,  System::qzss,
                                          System::glonass, System::navic};
  if (gnss >= systems.size() || gnss == 4) return {};  // 4 is indoor messaging
  const int shift = systems[gnss] == System::sbas ? 100 : 0;
  const int rinex = number - shift;
  if (rinex < 1 || rinex > 99) return {};  // 255 is a GLONASS satellite with unknown number
  return Satellite{systems[gnss], static_cast<std::uint8_t>(rinex)};
}

bool UbxFrames::next(UbxFrame& frame) {
  while (at_ < bytes_.size()) {
    const std::size_t sync = bytes_.find("\xb5\x62", at_);
    const bool half = more_follow_ && bytes_.back() == '\xb5';
    const std::size_t begin =
        sync == std::string_view::npos ? bytes_.size() - (half ? 1 : 0) : sync;
    others_ += begin - at_;
    at_ = begin;
    const std::string_view rest = bytes_.substr(begin);
    if (rest.empty() || (more_follow_ && !ubx_whole(rest))) return false;
    if (rest.size() >= ubx_head + ubx_tail) {
      const std::size_t length = ubx_number<std::uint16_t>(rest, 4);
      const std::size_t size = ubx_head + length + ubx_tail;
      if (size <= rest.size() &&
          sound(rest.substr(2, ubx_head - 2 + length), rest.substr(ubx_head + length, ubx_tail))) {
        frame.message_class = static_cast<std::uint8_t>(rest[2]);
        frame.id = static_cast<std::uint8_t>(rest[3]);
        frame.payload = rest.substr(ubx_head, length);
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
