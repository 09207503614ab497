// This index finds the segments of the map in a box with Boost.Geometry's R-tree. It is immutable
// after construction: any number of threads may query it at the same time, and its copies share the
// tree. Queries do not allocate.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
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
  std::uint32_t vertex = 0;  // index of its first vertex in the network
};

class SegmentIndex {
 public:
  SegmentIndex();
  // boxes[i] (m) is the box of segments[i]; both have the same length.
  SegmentIndex(const std::vector<IndexedSegment>& segments, const std::vector<Box>& boxes);

  std::size_t size() const;

  // Calls visit(segment) for each segment whose box meets `box`, in unspecified order.
  template <class Visit>
  void visit(const Box& box, Visit&& visit) const {
    using Visitor = std::remove_reference_t<Visit>;
    query(
        box,
        [](void* visitor, const IndexedSegment& segment) {
          (*static_cast<Visitor*>(visitor))(segment);
        },
        &visit);
  }

 private:
  using Found = void (*)(void* visitor, const IndexedSegment& segment);
  void query(const Box& box, Found found, void* visitor) const;

  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

}  // namespace maploop::mapmatch
