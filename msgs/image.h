// Grey images as they travel through the rings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "msgs/sample.h"

namespace maploop {

// 8-bit grey, rows without padding. Buffers keep their capacity, so that swapping and resizing to
// a size seen before does not allocate.
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
};

template <class Archive>
void archive(Archive& ar, GreyImage& image) {
  ar(image.width, image.height, image.pixels);
}

// Rectified pair, exposed at one moment: `stamp`.
struct StereoPair : Sample {
  GreyImage left;
  GreyImage right;
};

}  // namespace maploop
