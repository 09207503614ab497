// This file splits the bytes of a stream into lines of text.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace maploop::sensors {

// Lines that are too long are dropped and counted. One thread at a time; does not allocate.
class LineSplitter {
 public:
  // Takes bytes up to the end of a line off `bytes`. Returns true with the line, without its line
  // end, which is valid until the next call; returns false when all bytes are taken.
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

  // Discards the incomplete line; the next bytes do not continue it.
  void restart() {
    size_ = 0;
    overlong_ = false;
  }

  std::uint64_t dropped() const { return dropped_; }

 private:
  std::array<char, 256> line_{};  // an NMEA line has at most 82
  std::size_t size_ = 0;
  bool overlong_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace maploop::sensors
