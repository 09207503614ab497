// This file inflates the parts of a recording that are compressed by bzip2, LZ4 (frames) or
// Zstandard, compresses them, and has the checksum of parts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sensors/bag/byte_cursor.h"

namespace maploop::sensors::bag {

constexpr std::array<std::uint8_t, 4> zstd_magic{0x28, 0xb5, 0x2f, 0xfd};
bool is_zstd(Bytes bytes);

struct Inflated {
  Bytes bytes;        // as far as they could be inflated; in the buffer, or those that were given
  std::string error;  // empty if that is everything
};

struct InflatedSize {
  std::uint64_t stated = 0;
  bool exact = false;  // else it is a hint, or not known
};

// Inflates `packed`. If the size is not exact, that is the end of the data, and at most
// input_limits::chunk bytes. The buffer grows with what has been inflated, not with what the size
// promises, and never shrinks. `compression` is "" or "none", "bz2", "lz4" or "zstd"; others are an
// error.
Inflated inflate(std::string_view compression, Bytes packed, InflatedSize size,
                 std::vector<std::uint8_t>& buffer);

// Compresses to one frame: "none", "bz2", "lz4" or "zstd". Throws std::invalid_argument for another
// compression, and std::bad_alloc.
std::string pack(std::string_view compression, std::string_view plain);

// Returns the CRC-32 of zlib; `before` is that of the bytes in front of these.
std::uint32_t crc_of(Bytes bytes, std::uint32_t before = 0);

}  // namespace maploop::sensors::bag
