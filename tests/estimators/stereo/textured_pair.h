// Stereo pairs of a textured wall are generated here without any file.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "msgs/image.h"

namespace maploop::testing {

// The wall has a smooth random texture that fills both images: its point at column x + shift, row y
// of the left image is seen `disparity` columns further left in the right image. The texture comes
// from a fixed table, so it is the same on every machine.
class TexturedWall {
 public:
  TexturedWall() {
    std::mt19937 random(42);
    for (float& value : grid_) value = static_cast<float>(random() % 200) + 20.0f;
  }

  StereoPair pair(int width, int height, double shift, double disparity) const {
    StereoPair pair;
    draw(width, height, shift, &pair.left);
    draw(width, height, shift + disparity, &pair.right);
    return pair;
  }

 private:
  static constexpr int grid_side = 512;        // grid points per side, then the texture repeats
  static constexpr double grid_spacing = 5.0;  // px between grid points

  float at(int x, int y) const {
    return grid_[static_cast<std::size_t>((y & 511) * grid_side + (x & 511))];
  }

  void draw(int width, int height, double shift, GreyImage* image) const {
    image->resize(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double gx = (x + shift + 10000.0) / grid_spacing, gy = y / grid_spacing;
        const int ix = static_cast<int>(gx), iy = static_cast<int>(gy);
        const double fx = smooth(gx - ix), fy = smooth(gy - iy);
        const double top = at(ix, iy) * (1.0 - fx) + at(ix + 1, iy) * fx;
        const double bottom = at(ix, iy + 1) * (1.0 - fx) + at(ix + 1, iy + 1) * fx;
        image->pixels[static_cast<std::size_t>(y * width + x)] =
            static_cast<std::uint8_t>(top * (1.0 - fy) + bottom * fy);
      }
  }

  static double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

  std::vector<float> grid_ = std::vector<float>(grid_side * grid_side);
};

}  // namespace maploop::testing
