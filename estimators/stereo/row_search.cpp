#include "estimators/stereo/row_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace maploop::stereo {
namespace {

constexpr int patch_side = 8;     // px; (x, y) is the patch's fifth pixel of its fifth row
constexpr int pixels_before = 4;  // pixels before it
constexpr int patch_pixels = patch_side * patch_side;
constexpr double rival_share = 0.95;  // a rival this close to the best makes the match ambiguous
constexpr int elsewhere_from = 2;     // px of disparity

bool holds_patch(const PixelView& image, int x, int y) {
  return x >= pixels_before && y >= pixels_before &&
         x + patch_side - pixels_before <= image.width &&
         y + patch_side - pixels_before <= image.height;
}

}  // namespace

void RowSearch::correlate(const PixelView& left, const PixelView& right, int x, int y, int count) {
  std::array<std::int16_t, patch_pixels> patch;
  std::int32_t sum = 0, squares = 0;
  for (std::size_t row = 0; row < patch_side; ++row) {
    const std::uint8_t* from =
        left.row(y - pixels_before + static_cast<int>(row)) + x - pixels_before;
    for (std::size_t i = 0; i < patch_side; ++i) {
      patch[row * patch_side + i] = from[i];
      sum += from[i];
      squares += from[i] * from[i];
    }
  }

  const auto columns = static_cast<std::size_t>(count) + patch_side - 1;
  strip_.resize(columns * patch_side);
  sums_.assign(columns, 0);
  squares_.assign(columns, 0);
  for (std::size_t row = 0; row < patch_side; ++row) {
    const std::uint8_t* from =
        right.row(y - pixels_before + static_cast<int>(row)) + x - pixels_before - (count - 1);
    for (std::size_t i = 0; i < columns; ++i) {
      strip_[row * columns + i] = from[i];
      sums_[i] += from[i];
      squares_[i] += from[i] * from[i];
    }
  }

  correlation_.resize(static_cast<std::size_t>(count));
  const double own_variance = static_cast<double>(patch_pixels * squares - sum * sum);
  for (std::size_t d = 0; d < static_cast<std::size_t>(count); ++d) {
    const std::size_t first = static_cast<std::size_t>(count) - 1 - d;
    std::int32_t products = 0, right_sum = 0, right_squares = 0;
    for (std::size_t row = 0; row < patch_side; ++row) {
      for (std::size_t i = 0; i < patch_side; ++i)
        products += patch[row * patch_side + i] * strip_[row * columns + first + i];
    }
    for (std::size_t i = 0; i < patch_side; ++i) {
      right_sum += sums_[first + i];
      right_squares += squares_[first + i];
    }
    const double scale = std::sqrt(
        own_variance * static_cast<double>(patch_pixels * right_squares - right_sum * right_sum));
    correlation_[d] =
        scale > 0.0 ? static_cast<double>(patch_pixels * products - sum * right_sum) / scale : 0.0;
  }
}

int RowSearch::best_disparity(const PixelView& left, const PixelView& right, int x, int y,
                              int farthest, double min_correlation) {
  if (!holds_patch(left, x, y)) return -1;
  const int count = std::min(farthest, x - pixels_before) + 1;
  correlate(left, right, x, y, count);
  const auto best = std::max_element(correlation_.begin(), correlation_.end());
  if (*best < min_correlation) return -1;
  const auto disparity = static_cast<int>(best - correlation_.begin());
  for (int d = 0; d < count; ++d) {
    if (std::abs(d - disparity) > elsewhere_from &&
        correlation_[static_cast<std::size_t>(d)] > rival_share * *best)
      return -1;
  }
  return disparity;
}

}  // namespace maploop::stereo
