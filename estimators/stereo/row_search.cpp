#include "estimators/stereo/row_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace maploop::stereo {
namespace {

constexpr int kSide = 8;    // px; (x, y) is the patch's fifth pixel of its fifth row
constexpr int kBefore = 4;  // pixels before it
constexpr int kPixels = kSide * kSide;
constexpr double kRival = 0.95;  // a rival this close to the best makes the match ambiguous
constexpr int kElsewhere = 2;    // px of disparity

bool holds_patch(const PixelView& image, int x, int y) {
  return x >= kBefore && y >= kBefore && x + kSide - kBefore <= image.width &&
         y + kSide - kBefore <= image.height;
}

}  // namespace

void RowSearch::correlate(const PixelView& left, const PixelView& right, int x, int y, int count) {
  std::array<std::int16_t, kPixels> patch;
  std::int32_t sum = 0, squares = 0;
  for (std::size_t row = 0; row < kSide; ++row) {
    const std::uint8_t* from = left.row(y - kBefore + static_cast<int>(row)) + x - kBefore;
    for (std::size_t i = 0; i < kSide; ++i) {
      patch[row * kSide + i] = from[i];
      sum += from[i];
      squares += from[i] * from[i];
    }
  }

  const auto columns = static_cast<std::size_t>(count) + kSide - 1;
  strip_.resize(columns * kSide);
  sums_.assign(columns, 0);
  squares_.assign(columns, 0);
  for (std::size_t row = 0; row < kSide; ++row) {
    const std::uint8_t* from =
        right.row(y - kBefore + static_cast<int>(row)) + x - kBefore - (count - 1);
    for (std::size_t i = 0; i < columns; ++i) {
      strip_[row * columns + i] = from[i];
      sums_[i] += from[i];
      squares_[i] += from[i] * from[i];
    }
  }

  correlation_.resize(static_cast<std::size_t>(count));
  const double own_variance = static_cast<double>(kPixels * squares - sum * sum);
  for (std::size_t d = 0; d < static_cast<std::size_t>(count); ++d) {
    const std::size_t first = static_cast<std::size_t>(count) - 1 - d;
    std::int32_t products = 0, right_sum = 0, right_squares = 0;
    for (std::size_t row = 0; row < kSide; ++row)
      for (std::size_t i = 0; i < kSide; ++i)
        products += patch[row * kSide + i] * strip_[row * columns + first + i];
    for (std::size_t i = 0; i < kSide; ++i) {
      right_sum += sums_[first + i];
      right_squares += squares_[first + i];
    }
    const double scale = std::sqrt(
        own_variance * static_cast<double>(kPixels * right_squares - right_sum * right_sum));
    correlation_[d] =
        scale > 0.0 ? static_cast<double>(kPixels * products - sum * right_sum) / scale : 0.0;
  }
}

int RowSearch::best_disparity(const PixelView& left, const PixelView& right, int x, int y,
                              int farthest, double min_correlation) {
  if (!holds_patch(left, x, y)) return -1;
  const int count = std::min(farthest, x - kBefore) + 1;
  correlate(left, right, x, y, count);
  const auto best = std::max_element(correlation_.begin(), correlation_.end());
  if (*best < min_correlation) return -1;
  const auto disparity = static_cast<int>(best - correlation_.begin());
  for (int d = 0; d < count; ++d)
    if (std::abs(d - disparity) > kElsewhere &&
        correlation_[static_cast<std::size_t>(d)] > kRival * *best)
      return -1;
  return disparity;
}

}  // namespace maploop::stereo
