// Finds the frames of u-blox's UBX protocol in a stream of bytes, which may contain other text
// (NMEA).
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
  std::size_t offset = 0;    // offset of the frame's first byte in the stream
};

class UbxFrames {
 public:
  // `bytes` must outlive this. If more bytes follow, an incomplete frame at the end does not count
  // as damaged; see consumed(). A frame longer than any that is decoded counts as damaged at once.
  explicit UbxFrames(std::string_view bytes, bool more_follow = false)
      : bytes_(bytes), more_follow_(more_follow) {}

  // Finds the next frame with a right checksum; false at the end. After a wrong checksum the search
  // continues one byte after the frame's start, because its length may be the damaged part.
  bool next(UbxFrame& frame);

  // Returns the number of bytes that are finished. The remaining bytes must be put before the
  // following ones.
  std::size_t consumed() const { return at_; }

  // Returns the number of frame starts whose frame is cut or has a wrong checksum.
  std::size_t damaged() const { return damaged_; }
  std::size_t others() const { return others_; }  // bytes that are in no frame

 private:
  std::string_view bytes_;
  bool more_follow_;
  std::size_t at_ = 0;
  std::size_t damaged_ = 0;
  std::size_t others_ = 0;
};

// Converts u-blox's numbers of system and satellite; nothing if RINEX has no name for it.
std::optional<Satellite> ubx_satellite(std::uint8_t gnss, std::uint8_t number);

// Returns a little-endian number of a payload. Precondition: the payload contains all of its bytes.
template <class T>
T ubx_number(std::string_view payload, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T value{};
  std::memcpy(&value, payload.data() + at, sizeof value);
  return value;
}

}  // namespace maploop::ppp
