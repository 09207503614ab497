// This file defines grey images as they are passed through the rings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "msgs/sample.h"

namespace maploop {

// Holds 8-bit grey pixels in rows without padding. Buffers keep their capacity, so that swapping,
// and resizing to an earlier size, does not allocate.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    pixels.resize(static_cast<std::size_t>(new_width) * static_cast<std::size_t>(new_height));
  }
  bool empty() const { return width == 0 || height == 0; }

  void archive(auto& ar) { ar(width, height, pixels); }
};

// This is a rectified pair, exposed at one moment: `stamp`.
struct StereoPair : Sample {
  GreyImage left;
  GreyImage right;

  void archive(auto& ar) { ar(static_cast<Sample&>(*this), left, right); }
};

}  // namespace maploop
