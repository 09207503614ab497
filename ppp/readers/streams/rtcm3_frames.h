// Finds the messages of an RTCM 3 stream and reads the bits in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace maploop::ppp {

struct Rtcm3Message {
  int number = 0;
  std::string_view payload;  // a view into the stream, starting with the number
  std::size_t offset = 0;    // offset of the frame's first byte in the stream
};

// Returns the checksum of frames and of Galileo's pages: polynomial 0x1864cfb, initial value zero.
std::uint32_t crc24q(std::string_view bytes);

class Rtcm3Frames {
 public:
  // `bytes` must outlive this. If more bytes follow, an incomplete frame at the end does not count
  // as damaged; see consumed().
  explicit Rtcm3Frames(std::string_view bytes, bool more_follow = false)
      : bytes_(bytes), more_follow_(more_follow) {}

  // Finds the next message with a right checksum; false at the end. After a wrong checksum the
  // search continues one byte after the frame's start.
  bool next(Rtcm3Message& message);

  // Returns the number of bytes that are finished. The remaining bytes must be put before the
  // following ones.
  std::size_t consumed() const { return at_; }
  // Returns the number of frame starts whose frame is cut or has a wrong checksum.
  std::size_t damaged() const { return damaged_; }

 private:
  std::string_view bytes_;
  bool more_follow_;
  std::size_t at_ = 0;
  std::size_t damaged_ = 0;
};

// Reads a payload bit by bit, the highest first. Beyond its end, bits are zero and good() is false.
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
