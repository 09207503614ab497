// The frames of u-blox's UBX protocol inside a stream of bytes, which may hold other text (NMEA).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "ppp/satellite.h"

namespace maploop::ppp {

struct UbxFrame {
  std::uint8_t message_class = 0, id = 0;
  std::string_view payload;  // a view into the stream
  std::size_t offset = 0;    // of its first byte in the stream
};

class UbxFrames {
 public:
  // `bytes` must outlive this. Where more bytes follow them, a frame that is not whole yet is no
  // damage: see taken(). It then is longer than any that is decoded only by damage.
  explicit UbxFrames(std::string_view bytes, bool more_follow = false)
      : bytes_(bytes), more_follow_(more_follow) {}

  // The next frame with a right checksum; false at the end. After one with a wrong checksum the
  // search goes on behind its first byte, for its length may be what is damaged.
  bool next(UbxFrame& frame);

  // Bytes that are done with: what follows is to be preceded by the others.
  std::size_t taken() const { return at_; }

  std::size_t damaged() const {
    return damaged_;
  }                                               // begins of frames with a wrong checksum, or cut
  std::size_t others() const { return others_; }  // bytes that are in no frame

 private:
  std::string_view bytes_;
  bool more_follow_;
  std::size_t at_ = 0;
  std::size_t damaged_ = 0;
  std::size_t others_ = 0;
};

// By u-blox's numbers of systems and satellites; nothing where RINEX has no name for it.
std::optional<Satellite> ubx_satellite(std::uint8_t gnss, std::uint8_t number);

// A little-endian number of a payload, which must reach so far.
template <class T>
T ubx_number(std::string_view payload, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T value{};
  std::memcpy(&value, payload.data() + at, sizeof value);
  return value;
}

}  // namespace maploop::ppp
