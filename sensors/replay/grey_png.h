// Images as KITTI stores them.
#pragma once

#include <vector>

#include "msgs/image.h"

namespace maploop::sensors {

// Decodes an 8-bit grey PNG file of exactly width x height pixels into `image`, without allocating
// where its buffer has that size already. Throws std::runtime_error with the reason alone (no
// image, cut, another size, colour or 16 bits); the content of `image` is then undefined.
void decode_grey_png(const std::vector<char>& bytes, int width, int height, GreyImage& image);

}  // namespace maploop::sensors
