#include "tools/match/map_corrections.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "mapmatch/foot_point.h"
#include "msgs/frames.h"
#include "msgs/local_frame.h"

namespace maploop::match {
namespace {

using mapmatch::MapExtract;
using mapmatch::MapNode;
using mapmatch::MapWay;

constexpr std::int64_t first_added = std::int64_t{1} << 50;
constexpr double reach = 100.0;      // m: the matcher takes so long to leave the road that ends
constexpr double on_the_road = 5.0;  // m
constexpr double most = 0.7;         // of the points of a track
constexpr double same_node = 5.0;    // m

// Returns the point of a segment that is nearest to the origin.
Eigen::Vector2d foot(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  return a + mapmatch::foot_share(Eigen::Vector2d::Zero(), a, along) * along;
}

class Corrector {
 public:
  explicit Corrector(MapExtract& map) : map_(map) {
    if (!map.nodes.empty()) next_node_ = std::max(next_node_, map.nodes.back().id + 1);
    for (const MapWay& way : map.ways) next_way_ = std::max(next_way_, way.road.way_id + 1);
  }

  // A road that the map has by now, or that would be an island, is left.
  bool add_road(const MapDoubt& doubt) {
    if (doubt.track_count == 0 || is_there(doubt)) return false;
    const auto before = join(doubt.from.way_id, doubt.track[0]);
    const auto after = join(doubt.to.way_id, doubt.track[doubt.track_count - 1]);
    if (!before && !after) return false;
    MapWay road;
    road.road.way_id = next_way_++;
    if (before) road.nodes.push_back(*before);
    for (std::size_t i = 0; i < doubt.track_count; ++i)
      road.nodes.push_back(add_node(doubt.track[i]));
    if (after) road.nodes.push_back(*after);
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
             return r.via_node == doubt.to.node_a && r.from_way == doubt.from.way_id &&
                    into != r.only;
           }) > 0;
  }

 private:
  std::int64_t add_node(const Geodetic& place) {
    map_.nodes.push_back({next_node_, degrees(place.latitude), degrees(place.longitude)});
    return next_node_++;
  }

  static Eigen::Vector2d place_of(const MapNode& node, const LocalFrame& frame) {
    return frame.to_enu({radians(node.latitude), radians(node.longitude), 0.0}).head<2>();
  }

  // Returns whether the map has roads along most of the track.
  bool is_there(const MapDoubt& doubt) const {
    const auto count = std::count_if(
        doubt.track.begin(), doubt.track.begin() + static_cast<std::ptrdiff_t>(doubt.track_count),
        [&](const Geodetic& place) { return is_on_road(place); });
    return static_cast<double>(count) >= most * static_cast<double>(doubt.track_count);
  }

  bool is_on_road(const Geodetic& place) const {
    const LocalFrame frame(place);
    const double latitude = degrees(place.latitude), longitude = degrees(place.longitude);
    const auto outside = [](double value, double a, double b) {
      constexpr double margin = 1e-3;  // degrees, more than on_the_road
      return value < std::min(a, b) - margin || value > std::max(a, b) + margin;
    };
    for (const MapWay& way : map_.ways) {
      for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
        const MapNode* a = map_.find(way.nodes[i]);
        const MapNode* b = map_.find(way.nodes[i + 1]);
        if (!a || !b || outside(latitude, a->latitude, b->latitude) ||
            outside(longitude, a->longitude, b->longitude))
          continue;
        if (foot(place_of(*a, frame), place_of(*b, frame)).norm() < on_the_road) return true;
      }
    }
    return false;
  }

  // Returns a node of the way near the place, which is added to the way where it has none; nothing
  // if the way is not within reach.
  std::optional<std::int64_t> join(std::int64_t way_id, const Geodetic& place) {
    const LocalFrame frame(place);
    double least = reach;
    MapWay* way = nullptr;
    std::size_t segment = 0;
    Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
    for (MapWay& w : map_.ways) {
      for (std::size_t i = 0; w.road.way_id == way_id && i + 1 < w.nodes.size(); ++i) {
        const MapNode* a = map_.find(w.nodes[i]);
        const MapNode* b = map_.find(w.nodes[i + 1]);
        if (!a || !b) continue;
        const Eigen::Vector2d p = foot(place_of(*a, frame), place_of(*b, frame));
        if (p.norm() >= least) continue;
        least = p.norm();
        way = &w;
        segment = i;
        nearest = p;
      }
    }
    if (way == nullptr) return {};
    for (const std::size_t i : {segment, segment + 1}) {
      if ((place_of(*map_.find(way->nodes[i]), frame) - nearest).norm() < same_node)
        return way->nodes[i];
    }
    const std::int64_t node = add_node(frame.to_geodetic({nearest.x(), nearest.y(), 0.0}));
    way->nodes.insert(way->nodes.begin() + static_cast<std::ptrdiff_t>(segment) + 1, node);
    return node;
  }

  MapExtract& map_;
  std::int64_t next_node_ = first_added, next_way_ = first_added;
};

}  // namespace

std::set<mapmatch::TilePlace> places_of(const std::vector<MapDoubt>& doubts) {
  std::set<mapmatch::TilePlace> places;
  for (const MapDoubt& doubt : doubts) {
    for (std::size_t i = 0; i < doubt.track_count; ++i) {
      const LocalFrame frame(doubt.track[i]);
      for (const double east : {-reach, reach}) {
        for (const double north : {-reach, reach}) {
          const Geodetic corner = frame.to_geodetic({east, north, 0.0});
          places.insert(mapmatch::tile_at(degrees(corner.latitude), degrees(corner.longitude)));
        }
      }
    }
  }
  return places;
}

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
