#include "mapmatch/segment_index.h"

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <utility>

namespace maploop::mapmatch {
namespace {

namespace geometry = boost::geometry;
using Corner = geometry::model::point<double, 2, geometry::cs::cartesian>;
using Rectangle = geometry::model::box<Corner>;
using Entry = std::pair<Rectangle, IndexedSegment>;

struct SameEntry {
  bool operator()(const Entry& a, const Entry& b) const {
    return a.second.vertex == b.second.vertex;
  }
};

Rectangle rectangle(const Box& b) {
  return {{b.west, b.south}, {b.east, b.north}};
}

std::vector<Entry> entries(const std::vector<IndexedSegment>& segments,
                           const std::vector<Box>& boxes) {
  std::vector<Entry> all;
  all.reserve(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i)
    all.emplace_back(rectangle(boxes[i]), segments[i]);
  return all;
}

}  // namespace

struct SegmentIndex::Tree {
  // It is built from all entries at once, which packs it.
  geometry::index::rtree<Entry, geometry::index::rstar<16>, geometry::index::indexable<Entry>,
                         SameEntry>
      rtree;
};

SegmentIndex::SegmentIndex() : SegmentIndex({}, {}) {}

SegmentIndex::SegmentIndex(const std::vector<IndexedSegment>& segments,
                           const std::vector<Box>& boxes)
    : tree_(std::make_shared<const Tree>(Tree{decltype(Tree::rtree)(entries(segments, boxes))})) {}

std::size_t SegmentIndex::size() const {
  return tree_->rtree.size();
}

void SegmentIndex::query(const Box& box, Found found, void* visitor) const {
  tree_->rtree.query(geometry::index::intersects(rectangle(box)),
                     boost::make_function_output_iterator(
                         [&](const Entry& entry) { found(visitor, entry.second); }));
}

}  // namespace maploop::mapmatch
