// This file reads and writes PNG images (ISO/IEC 15948) with libspng.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

bool is_png(std::span<const char> file);

// Decodes an 8-bit grey PNG file of exactly width x height pixels into `image`, whose buffer is
// reused. Throws std::runtime_error whose text is the reason only (not a PNG, cut, another size,
// colour or 16 bits); `image` is then unchanged, or holds the part that could be decoded.
void decode_grey_png(std::span<const char> file, int width, int height, GreyImage& image);

// Decodes a PNG file of any kind of at most input_limits::pixels; colours become their luma (ITU-R
// BT.601). Throws std::runtime_error whose text is the reason only.
GreyImage decode_any_png(std::span<const char> file);

enum class PngContent { picture, noise };  // noise does not repeat: repetitions are not searched

// Encodes rows without padding, one byte a pixel (grey) or three (red, green, blue); pixels.size()
// tells which. Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int width, int height,
                                     PngContent content = PngContent::picture);

}  // namespace maploop::sensors
