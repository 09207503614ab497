// PNG images (ISO/IEC 15948), by libspng.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

bool is_png(std::span<const char> file);

// Decodes an 8-bit grey PNG file of exactly width x height pixels into `image`, whose buffer is
// reused. Throws std::runtime_error with the reason alone (no PNG, cut, another size, colour or
// 16 bits); `image` is then left as it was, or holds what of it could be decoded.
void decode_grey_png(std::span<const char> file, int width, int height, GreyImage& image);

// Decodes a PNG file of any kind and size up to input_limits::pixels; colours become their luma
// (ITU-R BT.601). Throws std::runtime_error with the reason alone.
GreyImage decode_any_png(std::span<const char> file);

enum class PngContent { picture, noise };  // noise has no repetitions: these are not looked for

// `pixels`: rows without padding, one byte a pixel (grey) or three (red, green, blue), as
// pixels.size() says. Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int width, int height,
                                     PngContent content = PngContent::picture);

}  // namespace maploop::sensors
