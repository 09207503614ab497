#include "tools/match/map_corrections.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "msgs/frames.h"
#include "msgs/local_frame.h"

namespace maploop::match {
namespace {

using mapmatch::MapExtract;
using mapmatch::MapNode;
using mapmatch::MapWay;

constexpr double reach = 100.0;    // m: the matcher takes so long to leave the road that ends
constexpr double same_node = 5.0;  // m

class Corrector {
 public:
  explicit Corrector(MapExtract& map) : map_(map) {
    if (!map.nodes.empty()) next_node_ = map.nodes.back().id + 1;
    for (const MapWay& way : map.ways) next_way_ = std::max(next_way_, way.road.way_id + 1);
  }

  bool add_road(const MapDoubt& doubt) {
    if (doubt.track_count == 0) return false;
    MapWay road;
    road.road.way_id = next_way_++;
    const auto before = join(doubt.from.way_id, doubt.track[0]);
    if (before) road.nodes.push_back(*before);
    for (std::size_t i = 0; i < doubt.track_count; ++i)
      road.nodes.push_back(add_node(doubt.track[i]));
    const auto after = join(doubt.to.way_id, doubt.track[doubt.track_count - 1]);
    if (after) road.nodes.push_back(*after);
    if (road.nodes.size() < 2) return false;
    map_.ways.push_back(road);
    return true;
  }

  bool open_direction(const MapDoubt& doubt) {
    bool found = false;
    for (MapWay& way : map_.ways) {
      if (way.road.way_id != doubt.from.way_id) continue;
      way.road.forward = way.road.backward = true;
      found = true;
    }
    return found;
  }

  bool allow_turn(const MapDoubt& doubt) {
    return std::erase_if(map_.restrictions, [&](const mapmatch::MapRestriction& r) {
             const bool into = r.to_way == doubt.to.way_id;
             return r.from_way == doubt.from.way_id && into != r.only;
           }) > 0;
  }

 private:
  std::int64_t add_node(const Geodetic& place) {
    map_.nodes.push_back({next_node_, degrees(place.latitude), degrees(place.longitude)});
    return next_node_++;
  }

  std::optional<Eigen::Vector2d> position(std::int64_t id, const LocalFrame& frame) const {
    const auto node = std::lower_bound(map_.nodes.begin(), map_.nodes.end(), id,
                                       [](const MapNode& n, std::int64_t i) { return n.id < i; });
    if (node == map_.nodes.end() || node->id != id) return {};
    return frame.to_enu({radians(node->latitude), radians(node->longitude), 0.0}).head<2>();
  }

  // Returns a node of the way near the place, which is added to the way where it has none; nothing
  // if the way is not within reach.
  std::optional<std::int64_t> join(std::int64_t way_id, const Geodetic& place) {
    const LocalFrame frame(place);
    double least = reach;
    MapWay* way = nullptr;
    std::size_t segment = 0;
    Eigen::Vector2d foot = Eigen::Vector2d::Zero();
    for (MapWay& w : map_.ways) {
      for (std::size_t i = 0; w.road.way_id == way_id && i + 1 < w.nodes.size(); ++i) {
        const auto a = position(w.nodes[i], frame), b = position(w.nodes[i + 1], frame);
        if (!a || !b) continue;
        const Eigen::Vector2d along = *b - *a;
        const double length = along.squaredNorm();
        const double share = length > 0.0 ? std::clamp(-a->dot(along) / length, 0.0, 1.0) : 0.0;
        const Eigen::Vector2d p = *a + share * along;
        if (p.norm() >= least) continue;
        least = p.norm();
        way = &w;
        segment = i;
        foot = p;
      }
    }
    if (way == nullptr) return {};
    for (const std::size_t i : {segment, segment + 1})
      if ((*position(way->nodes[i], frame) - foot).norm() < same_node) return way->nodes[i];
    const std::int64_t node = add_node(frame.to_geodetic({foot.x(), foot.y(), 0.0}));
    way->nodes.insert(way->nodes.begin() + static_cast<std::ptrdiff_t>(segment) + 1, node);
    return node;
  }

  MapExtract& map_;
  std::int64_t next_node_ = 1, next_way_ = 1;
};

}  // namespace

Corrections correct(MapExtract& map, const std::vector<MapDoubt>& doubts) {
  Corrector corrector(map);
  Corrections done;
  for (const MapDoubt& doubt : doubts) {
    switch (doubt.kind) {
      case DoubtKind::missing_road:
        ++(corrector.add_road(doubt) ? done.roads : done.left);
        break;
      case DoubtKind::wrong_direction:
        ++(corrector.open_direction(doubt) ? done.directions : done.left);
        break;
      case DoubtKind::forbidden_turn:
        ++(corrector.allow_turn(doubt) ? done.turns : done.left);
        break;
      case DoubtKind::shifted_road:
        ++done.left;
        break;
    }
  }
  return done;
}

}  // namespace maploop::match
