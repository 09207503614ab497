#include "tools/calibrate/extrinsics/image_edges.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace maploop::extrinsics {
namespace {

constexpr double strong = 4.0;    // times the average
constexpr float fading = 0.9f;    // of the strength, from one pixel to the next
constexpr float on_edge = 0.33f;  // share of the pixel's own strength

// Spreads the strengths of a row to the left and right.
void spread(const float* own, int width, std::uint8_t* row) {
  std::vector<float> near(own, own + width);
  for (std::size_t x = 1; x < near.size(); ++x) near[x] = std::max(near[x], fading * near[x - 1]);
  for (std::size_t x = near.size() - 1; x > 0; --x)
    near[x - 1] = std::max(near[x - 1], fading * near[x]);
  for (std::size_t x = 0; x < near.size(); ++x)
    row[x] = static_cast<std::uint8_t>(255.0f * (on_edge * own[x] + (1.0f - on_edge) * near[x]));
}

}  // namespace

GreyImage vertical_edges(const GreyImage& image) {
  GreyImage result;
  result.resize(image.width, image.height);
  if (image.empty()) return result;
  const cv::Mat grey(image.height, image.width, CV_8U,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat smooth, change;
  cv::GaussianBlur(grey, smooth, {0, 0}, 1.0);
  cv::Sobel(smooth, change, CV_32F, 1, 0);
  change = cv::abs(change);
  const double full = std::max(1.0, strong * cv::mean(change)[0]);
  change = cv::min(change / full, 1.0);
  for (int y = 0; y < image.height; ++y) {
    spread(change.ptr<float>(y), image.width,
           result.pixels.data() + static_cast<std::ptrdiff_t>(y) * image.width);
  }
  return result;
}

}  // namespace maploop::extrinsics
