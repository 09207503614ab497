#include "mapmatch/segment_index.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace maploop::mapmatch {
namespace {

Box join(const Box& a, const Box& b) {
  return {std::min(a.west, b.west), std::min(a.south, b.south), std::max(a.east, b.east),
          std::max(a.north, b.north)};
}

constexpr Box nothing{
    std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

// Distance along the Hilbert curve of order 16 (Hilbert, 1891; the usual bitwise form).
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t d = 0;
  for (std::uint32_t side = 1U << 15U; side > 0; side /= 2) {
    const std::uint32_t right = (x & side) != 0 ? 1 : 0;
    const std::uint32_t up = (y & side) != 0 ? 1 : 0;
    d += side * side * ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = 0xffffU - x;
        y = 0xffffU - y;
      }
      std::swap(x, y);
    }
  }
  return d;
}

}  // namespace

SegmentIndex::SegmentIndex(std::vector<IndexedSegment> segments, const std::vector<Box>& boxes) {
  if (segments.empty()) return;
  const Box all = std::accumulate(boxes.begin(), boxes.end(), nothing, join);
  const double side = std::max({all.east - all.west, all.north - all.south, 1e-9});
  const auto cell = [&](double value, double low) {
    return static_cast<std::uint32_t>(std::clamp((value - low) / side * 65535.0, 0.0, 65535.0));
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(segments.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Box& b = boxes[i];
    order[i] = {hilbert(cell(0.5 * (b.west + b.east), all.west),
                        cell(0.5 * (b.south + b.north), all.south)),
                i};
  }
  std::sort(order.begin(), order.end());
  for (const auto& [distance, i] : order) {
    segments_.push_back(segments[i]);
    boxes_.push_back(boxes[i]);
  }
  const std::vector<Box>* below = &boxes_;
  do {
    std::vector<Box> level((below->size() + fan_out - 1) / fan_out, nothing);
    for (std::size_t i = 0; i < below->size(); ++i)
      level[i / fan_out] = join(level[i / fan_out], (*below)[i]);
    levels_.push_back(std::move(level));
    below = &levels_.back();
  } while (below->size() > 1);
}

}  // namespace maploop::mapmatch
