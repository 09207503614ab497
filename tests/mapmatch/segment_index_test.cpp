#include "mapmatch/segment_index.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace maploop::mapmatch {
namespace {

TEST(SegmentIndex, FindsWhatASearchOfAllFinds) {
  for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 257u, 5000u}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> where(-1000.0, 1000.0);
    std::uniform_real_distribution<double> size(0.0, 60.0);
    std::vector<IndexedSegment> segments;
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double x = where(random), y = where(random);
      segments.push_back({i, i});
      boxes.push_back({x, y, x + size(random), y + size(random)});
    }
    const SegmentIndex index(segments, boxes);
    EXPECT_EQ(index.size(), count);
    for (int query = 0; query < 50; ++query) {
      const double x = where(random), y = where(random);
      const Box box{x, y, x + 80.0, y + 30.0};
      std::multiset<std::uint32_t> found, expected;
      index.visit(box, [&](const IndexedSegment& s) { found.insert(s.link); });
      for (std::uint32_t i = 0; i < count; ++i)
        if (boxes[i].meets(box)) expected.insert(i);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(SegmentIndex, AllAtOnePlace) {
  const std::vector<IndexedSegment> segments(100, {1, 2});
  const SegmentIndex index(segments, std::vector<Box>(100, Box{5, 5, 5, 5}));
  int found = 0;
  index.visit({4, 4, 6, 6}, [&](const IndexedSegment&) { ++found; });
  EXPECT_EQ(found, 100);
}

}  // namespace
}  // namespace maploop::mapmatch
