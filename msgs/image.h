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
  int width = 0;                     // px
  int height = 0;                    // px
  std::vector<std::uint8_t> pixels;  // width * height, row by row from the top; 0 is black

  // Sets the size in px. Pixels that were there are not moved to their new rows.
  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    pixels.resize(static_cast<std::size_t>(new_width) * static_cast<std::size_t>(new_height));
  }
  // Returns whether the image has no pixels.
  bool empty() const { return width == 0 || height == 0; }

  void archive(auto& ar) { ar(width, height, pixels); }
};

// This is a rectified pair, exposed at one moment: `stamp`.
struct StereoPair : Sample {
  GreyImage left;   // of the left camera
  GreyImage right;  // of the right camera, in the same rows

  void archive(auto& ar) { ar(static_cast<Sample&>(*this), left, right); }
};

}  // namespace maploop
