#include "runtime/vehicle/faults/image_faults.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "msgs/frames.h"
#include "runtime/vehicle/faults/fault_corruption.h"

namespace maploop::vehicle {
namespace {

template <class Change>
void each_image(StereoPair& pair, Change change) {
  for (GreyImage* image : {&pair.left, &pair.right}) change(*image);
}

// Replaces each of `count` pixels, `step` apart, by the mean of those at most `radius` away.
void blur_line(std::uint8_t* line, std::size_t count, std::size_t step, std::size_t radius,
               std::vector<std::uint32_t>& sums) {
  sums.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + line[i * step];
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i > radius ? i - radius : 0;
    const std::size_t end = std::min(count, i + radius + 1);
    line[i * step] = static_cast<std::uint8_t>((sums[end] - sums[begin]) / (end - begin));
  }
}

// The grey value between pixels by bilinear interpolation; 0 outside of the image.
std::uint8_t between(const GreyImage& image, double column, double row) {
  const double u = std::floor(column), v = std::floor(row);
  if (u < 0.0 || v < 0.0 || u + 1.0 >= image.width || v + 1.0 >= image.height) return 0;
  const auto width = static_cast<std::size_t>(image.width);
  const std::uint8_t* p =
      image.pixels.data() + static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
  const double a = column - u, b = row - v;
  const double upper = (1.0 - a) * p[0] + a * p[1];
  const double lower = (1.0 - a) * p[width] + a * p[width + 1];
  return static_cast<std::uint8_t>(std::lround((1.0 - b) * upper + b * lower));
}

GreyImage turned(const GreyImage& image, double angle, double focal_length) {
  GreyImage result = image;
  const double centre_u = 0.5 * (image.width - 1), centre_v = 0.5 * (image.height - 1);
  const double sine = std::sin(angle), cosine = std::cos(angle);
  std::size_t pixel = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      // The ray through the pixel of the turned camera, in the axes of the camera before.
      const double x = (u - centre_u) / focal_length;
      const double ahead = cosine + x * sine;
      const double aside = x * cosine - sine;
      result.pixels[pixel++] = ahead <= 0.0
                                   ? std::uint8_t{0}
                                   : between(image, centre_u + focal_length * aside / ahead,
                                             centre_v + (v - centre_v) / ahead);
    }
  }
  return result;
}

}  // namespace

void blacken(StereoPair& pair) {
  each_image(pair, [](GreyImage& image) {
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
  });
}

void scramble(StereoPair& pair, std::uint64_t seed) {
  std::mt19937_64 random = generator(seed, pair.stamp);
  each_image(pair, [&random](GreyImage& image) {
    for (std::uint8_t& pixel : image.pixels) pixel = static_cast<std::uint8_t>(random() >> 56U);
  });
}

void blur(StereoPair& pair, int radius) {
  std::vector<std::uint32_t> sums;
  each_image(pair, [&](GreyImage& image) {
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    const auto reach = static_cast<std::size_t>(radius);
    for (std::size_t v = 0; v < height; ++v)
      blur_line(image.pixels.data() + v * width, width, 1, reach, sums);
    for (std::size_t u = 0; u < width; ++u)
      blur_line(image.pixels.data() + u, height, width, reach, sums);
  });
}

void dim(StereoPair& pair, double lost) {
  each_image(pair, [lost](GreyImage& image) {
    for (std::uint8_t& pixel : image.pixels)
      pixel = static_cast<std::uint8_t>((1.0 - lost) * pixel);
  });
}

void turn(StereoPair& pair, double angle, double focal_length) {
  each_image(pair, [=](GreyImage& image) { image = turned(image, angle, focal_length); });
}

void distort(StereoPair& pair, const Strike& strike) {
  using enum FaultKind;
  switch (strike.kind) {
    case black:
      return blacken(pair);
    case garbage:
      return scramble(pair, strike.seed);
    case blurred:
      return blur(pair, static_cast<int>(std::ceil(strike.by)));
    case dimmed:
      return dim(pair, strike.by);
    case bumped:
      return turn(pair, radians(strike.by), strike.focal_length);
    default:
      return;
  }
}

}  // namespace maploop::vehicle
