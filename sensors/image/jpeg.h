// This file reads and writes JPEG images with libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

// Decodes the luminance of a JPEG file of at most input_limits::pixels. Throws std::runtime_error
// whose text is the reason only (no file name).
GreyImage decode_grey_jpeg(std::span<const char> file);

// Encodes rows without padding, one byte a pixel (grey) or three (red, green, blue); pixels.size()
// tells which. `quality` is 1 to 100. `file` keeps its capacity. Throws std::runtime_error.
void encode_jpeg(std::span<const std::uint8_t> pixels, int width, int height, int quality,
                 std::vector<std::uint8_t>& file);

}  // namespace maploop::sensors
