// Lines of text out of the bytes of a stream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace maploop::sensors {

// Longer lines are dropped and counted. One thread at a time; allocates nothing.
class LineSplitter {
 public:
  // Bytes up to the end of a line are taken off `bytes`: true with the line, without its end, which
  // is valid until the next call; false when all bytes are taken.
  bool next(std::span<const std::uint8_t>& bytes, std::string_view& line) {
    while (!bytes.empty()) {
      const char c = static_cast<char>(bytes.front());
      bytes = bytes.subspan(1);
      if (c == '\n') {
        line = {line_.data(), size_};
        const bool whole = !overlong_ && size_ > 0;
        if (overlong_) ++dropped_;
        size_ = 0;
        overlong_ = false;
        if (whole) return true;
      } else if (size_ < line_.size()) {
        line_[size_++] = c;
      } else {
        overlong_ = true;
      }
    }
    return false;
  }

  // What comes next does not go on with what came.
  void restart() {
    size_ = 0;
    overlong_ = false;
  }

  std::uint64_t dropped() const { return dropped_; }

 private:
  std::array<char, 256> line_{};  // NMEA's lines have 82
  std::size_t size_ = 0;
  bool overlong_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace maploop::sensors
