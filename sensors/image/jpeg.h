// JPEG images, by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

// The brightness of a JPEG file of up to input_limits::pixels. Throws std::runtime_error with
// the reason alone.
GreyImage decode_grey_jpeg(std::span<const char> file);

// `pixels`: rows without padding, one byte a pixel (grey) or three (red, green, blue), as
// pixels.size() says. `quality`: 1 to 100. `file` keeps its capacity. Throws std::runtime_error.
void encode_jpeg(std::span<const std::uint8_t> pixels, int width, int height, int quality,
                 std::vector<std::uint8_t>& file);

}  // namespace maploop::sensors
