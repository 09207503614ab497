// The messages of an RTCM 3 stream, and the bits in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace maploop::ppp {

struct Rtcm3Message {
  int number = 0;
  std::string_view payload;  // a view into the stream; it begins with the number
  std::size_t offset = 0;    // of the frame's first byte in the stream
};

// The checksum of frames, and of Galileo's pages: the polynomial 0x1864cfb, begun with zero.
std::uint32_t crc24q(std::string_view bytes);

class Rtcm3Frames {
 public:
  // `bytes` must outlive this. Where more bytes follow them, a frame that is not whole yet is no
  // damage: see taken().
  explicit Rtcm3Frames(std::string_view bytes, bool more_follow = false)
      : bytes_(bytes), more_follow_(more_follow) {}

  // The next message with a right checksum; false at the end. After one with a wrong checksum the
  // search goes on behind its first byte.
  bool next(Rtcm3Message& message);

  // Bytes that are done with: what follows is to be preceded by the others.
  std::size_t taken() const { return at_; }
  std::size_t damaged() const {
    return damaged_;
  }  // begins of frames with a wrong checksum, or cut

 private:
  std::string_view bytes_;
  bool more_follow_;
  std::size_t at_ = 0;
  std::size_t damaged_ = 0;
};

// Reads a payload bit by bit, the highest first. Behind its end there are zeros, and good() is
// false.
class Rtcm3Bits {
 public:
  explicit Rtcm3Bits(std::string_view payload) : payload_(payload) {}

  std::uint64_t number(std::size_t bits);        // at most 64
  std::int64_t signed_number(std::size_t bits);  // two's complement
  void skip(std::size_t bits) { at_ += bits; }
  bool good() const { return at_ <= 8 * payload_.size(); }

 private:
  std::string_view payload_;
  std::size_t at_ = 0;
};

}  // namespace maploop::ppp
