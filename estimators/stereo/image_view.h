// This file defines a view of grey pixels that the caller keeps, such as those of another library.
#pragma once

#include <cstdint>

#include "msgs/image.h"

namespace maploop::stereo {

// Refers to 8-bit grey pixels in rows without padding, which must outlive the view.
struct ImageView {
  ImageView() = default;
  // Views columns * rows pixels, row by row; `first` is the top left one.
  ImageView(int columns, int rows, const std::uint8_t* first)
      : width(columns), height(rows), pixels(first) {}
  // An image that does not have the pixels of its size gives an empty view.
  ImageView(const GreyImage& image) {
    if (image.pixels.size() !=
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      return;
    *this = ImageView(image.width, image.height, image.pixels.data());
  }

  int width = 0;                         // px
  int height = 0;                        // px
  const std::uint8_t* pixels = nullptr;  // the top left one first, row by row; nullptr: empty view
};

}  // namespace maploop::stereo
