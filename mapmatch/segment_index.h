// Where segments of the map are: a packed R-tree.
//
// Segments are sorted along a Hilbert curve of their centres and grouped by 16, level by level
// (Kamel and Faloutsos, "On Packing R-trees", 1993). tests/benchmarks/map_benchmark.cpp compares it
// with Boost.Geometry's. Immutable once built; queries do not allocate.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace maploop::mapmatch {

struct Box {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;

  bool meets(const Box& o) const {
    return west <= o.east && o.west <= east && south <= o.north && o.south <= north;
  }
};

struct IndexedSegment {
  std::uint32_t link = 0;
  std::uint32_t vertex = 0;  // where it begins, of all vertices
};

class SegmentIndex {
 public:
  SegmentIndex() = default;
  // boxes[i] is segments[i]'s; both are as long.
  SegmentIndex(std::vector<IndexedSegment> segments, const std::vector<Box>& boxes);

  std::size_t size() const { return segments_.size(); }

  // Calls visit(segment) for each whose box meets `box`.
  template <class Visit>
  void visit(const Box& box, Visit&& visit) const {
    if (levels_.empty()) return;
    struct Entry {
      std::uint32_t level, node;
    };
    std::array<Entry, fan_out * max_levels> open;
    std::size_t count = 0;
    open[count++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (count > 0) {
      const Entry e = open[--count];
      const std::vector<Box>& below = e.level == 0 ? boxes_ : levels_[e.level - 1];
      const std::size_t first = std::size_t{e.node} * fan_out;
      const std::size_t last = std::min(first + fan_out, below.size());
      for (std::size_t i = first; i < last; ++i) {
        if (!below[i].meets(box)) continue;
        if (e.level == 0) {
          visit(segments_[i]);
        } else {
          open[count++] = {e.level - 1, static_cast<std::uint32_t>(i)};
        }
      }
    }
  }

 private:
  static constexpr std::size_t fan_out = 16;
  static constexpr std::size_t max_levels = 9;  // 16^8 segments are more than 32 bits count

  std::vector<IndexedSegment> segments_;
  std::vector<Box> boxes_;                // of the segments
  std::vector<std::vector<Box>> levels_;  // of 16 of the level below; the last has one
};

}  // namespace maploop::mapmatch
