// Images as KITTI stores them.
#pragma once

#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

// Decodes an 8-bit grey PNG file of exactly width x height pixels into `image`, whose buffer is
// reused. Throws std::runtime_error with the reason alone (no image, cut, another size, colour or
// 16 bits), and leaves `image` as it was.
void decode_grey_png(const std::vector<char>& bytes, int width, int height, GreyImage& image);

}  // namespace maploop::sensors
