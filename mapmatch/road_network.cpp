#include "mapmatch/road_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

SegmentIndex index_of(const NetworkData& data) {
  std::vector<IndexedSegment> segments;
  std::vector<Box> boxes;
  for (std::uint32_t link = 0; link < data.links.size(); ++link) {
    const Link& l = data.links[link];
    for (std::uint32_t v = l.first_vertex; v + 1 < l.first_vertex + l.vertex_count; ++v) {
      const Vertex& a = data.vertices[v];
      const Vertex& b = data.vertices[v + 1];
      segments.push_back({link, v});
      boxes.push_back({std::min(a.east, b.east), std::min(a.north, b.north),
                       std::max(a.east, b.east), std::max(a.north, b.north)});
    }
  }
  return {segments, boxes};
}

auto order(const DirectedLink& d) {
  return std::tuple(d.link, d.forward);
}

}  // namespace

double LinkPoint::azimuth() const {
  return std::atan2(direction.x(), direction.y());
}

RoadNetwork::RoadNetwork(NetworkData data, RoadSide traffic)
    : data_(std::move(data)), frame_(data_.origin) {
  check();
  index_ = index_of(data_);
  one_way_checks_ = check_one_ways(*this);
  left_hand_traffic_ =
      traffic == RoadSide::by_map ? one_way_checks_.left_hand_traffic() : traffic == RoadSide::left;
}

void RoadNetwork::check() const {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("road network: ") + what);
  };
  const auto known = [&](const DirectedLink& d) { return d.link < data_.links.size(); };
  for (const Vertex& v : data_.vertices) {
    require(std::isfinite(v.east) && std::isfinite(v.north) && std::isfinite(v.along),
            "a position is not finite");
    require(v.road < data_.roads.size(), "a vertex has no road");
  }
  for (const Link& l : data_.links) {
    require(l.vertex_count >= 2 && l.first_vertex < data_.vertices.size() &&
                l.vertex_count <= data_.vertices.size() - l.first_vertex,
            "a link has no shape");
    require(l.start_junction < data_.junctions.size() && l.end_junction < data_.junctions.size(),
            "a link does not end at a junction");
    require(std::isfinite(l.length) && l.length > 0.0, "a link has no length");
    for (std::uint32_t v = l.first_vertex; v + 1 < l.first_vertex + l.vertex_count; ++v)
      require(data_.vertices[v].along <= data_.vertices[v + 1].along, "a link runs backwards");
  }
  for (const Junction& j : data_.junctions) {
    require(j.first_exit <= data_.exits.size() && j.exit_count <= data_.exits.size() - j.first_exit,
            "a junction's links are missing");
  }
  require(std::all_of(data_.exits.begin(), data_.exits.end(), known), "an exit is not a link");
  for (const BannedTurn& b : data_.banned)
    require(known(b.from) && known(b.to), "a banned turn is not between two links");
}

Eigen::Vector2d RoadNetwork::to_local(const Geodetic& place) const {
  return frame_.to_enu({place.latitude, place.longitude, 0.0}).head<2>();
}

Geodetic RoadNetwork::to_geodetic(const Eigen::Vector2d& place) const {
  // The height is chosen so that the place returns to the ellipsoid; 1 mm at 20 km is enough.
  Eigen::Vector3d p(place.x(), place.y(), 0.0);
  for (int i = 0; i < 2; ++i) p.z() -= frame_.to_geodetic(p).height;
  Geodetic g = frame_.to_geodetic(p);
  g.height = 0.0;
  return g;
}

bool RoadNetwork::allowed_turn(DirectedLink from, DirectedLink to) const {
  const auto [begin, end] = std::equal_range(
      data_.banned.begin(), data_.banned.end(), BannedTurn{from, to},
      [](const BannedTurn& a, const BannedTurn& b) { return order(a.from) < order(b.from); });
  return std::none_of(begin, end, [&](const BannedTurn& b) { return b.to == to; });
}

LinkPoint RoadNetwork::at(DirectedLink d, double s) const {
  const Link& l = link(d.link);
  const double along = d.forward ? s : l.length - s;
  const auto vertices = shape(d.link);
  const auto after = std::upper_bound(vertices.begin() + 1, vertices.end() - 1, along,
                                      [](double a, const Vertex& v) { return a < v.along; });
  const auto i = static_cast<std::uint32_t>(after - vertices.begin()) - 1;
  const Eigen::Vector2d a = vertices[i].position();
  const Eigen::Vector2d step = vertices[i + 1].position() - a;
  const double norm = step.norm();
  const Eigen::Vector2d unit = norm > 0.0 ? Eigen::Vector2d(step / norm) : Eigen::Vector2d::UnitX();
  return {a + unit * (along - vertices[i].along), d.forward ? unit : Eigen::Vector2d(-unit),
          l.first_vertex + i};
}

std::pair<std::int64_t, std::int64_t> RoadNetwork::nodes(DirectedLink d,
                                                         std::uint32_t vertex) const {
  const std::int64_t a = data_.vertices[vertex].node_id;
  const std::int64_t b = data_.vertices[vertex + 1].node_id;
  return d.forward ? std::pair(a, b) : std::pair(b, a);
}

}  // namespace maploop::mapmatch
