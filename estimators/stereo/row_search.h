// This search finds where along its row the right camera sees a left patch.
#pragma once

#include <cstdint>
#include <vector>

namespace maploop::stereo {

// Views an 8-bit grey image owned by the caller.
struct PixelView {
  const std::uint8_t* pixels = nullptr;
  std::ptrdiff_t stride = 0;  // bytes from one row to the next
  int width = 0;
  int height = 0;

  const std::uint8_t* row(int y) const { return pixels + y * stride; }
};

// Computes the normalized correlation of a left patch with right ones at the disparities 0, 1, 2,
// ... Buffers are kept from call to call. Not thread-safe.
class RowSearch {
 public:
  // Returns the whole-pixel disparity, up to `farthest`, at which the patch around (x, y)
  // correlates best. Returns a negative value if the best correlation is below `min_correlation` or
  // not unique, or if the patch leaves the image. Both images must have the same size.
  int best_disparity(const PixelView& left, const PixelView& right, int x, int y, int farthest,
                     double min_correlation);

 private:
  void correlate(const PixelView& left, const PixelView& right, int x, int y, int count);

  std::vector<std::int16_t> strip_;           // the right rows, patch_side of them
  std::vector<std::int32_t> sums_, squares_;  // of each column of the strip
  std::vector<double> correlation_;           // by disparity
};

}  // namespace maploop::stereo
