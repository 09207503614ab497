// The frames of u-blox's UBX protocol inside a stream of bytes, which may hold other text (NMEA).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace maploop::ppp {

struct UbxFrame {
  std::uint8_t message_class = 0, id = 0;
  std::string_view payload;  // a view into the stream
  std::size_t offset = 0;    // of its first byte in the stream
};

class UbxFrames {
 public:
  // `bytes` must outlive this.
  explicit UbxFrames(std::string_view bytes) : bytes_(bytes) {}

  // The next frame with a right checksum; false at the end. After one with a wrong checksum the
  // search goes on behind its first byte, for its length may be what is damaged.
  bool next(UbxFrame& frame);

  std::size_t damaged() const {
    return damaged_;
  }                                               // begins of frames with a wrong checksum, or cut
  std::size_t others() const { return others_; }  // bytes that are in no frame

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t damaged_ = 0;
  std::size_t others_ = 0;
};

// A little-endian number of a payload, which must reach so far.
template <class T>
T ubx_number(std::string_view payload, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T value{};
  std::memcpy(&value, payload.data() + at, sizeof value);
  return value;
}

}  // namespace maploop::ppp
