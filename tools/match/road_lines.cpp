#include "tools/match/road_lines.h"

#include <algorithm>
#include <limits>

namespace maploop::match {

mapmatch::Box box_about(const std::vector<Eigen::Vector2d>& places, double margin) {
  constexpr double far = std::numeric_limits<double>::infinity();
  mapmatch::Box box{far, far, -far, -far};
  for (const Eigen::Vector2d& p : places) {
    if (!p.allFinite()) continue;
    box = {std::min(box.west, p.x() - margin), std::min(box.south, p.y() - margin),
           std::max(box.east, p.x() + margin), std::max(box.north, p.y() + margin)};
  }
  return box;
}

std::vector<web::Line> road_lines(const mapmatch::RoadNetwork& network, const Geodetic& origin,
                                  const std::vector<web::Line>& lines, double reach) {
  const LocalFrame enu(origin);
  std::vector<Eigen::Vector2d> places;
  for (const web::Line& line : lines)
    for (std::size_t i = 0; i < line.x.size(); ++i)
      places.push_back(network.to_local(enu.to_geodetic({line.x[i], line.y[i], 0.0})));
  const mapmatch::Box box = box_about(places, reach);
  std::vector<web::Line> roads;
  if (!(box.west < box.east)) return roads;
  std::vector<bool> near(network.size(), false);
  network.index().visit(box, [&](const mapmatch::IndexedSegment& s) { near[s.link] = true; });
  for (std::uint32_t i = 0; i < network.size(); ++i) {
    if (!near[i]) continue;
    web::Line& road = roads.emplace_back();
    road.name = network.road_at(network.link(i).first_vertex).name;
    for (const mapmatch::Vertex& vertex : network.shape(i)) {
      Geodetic place = network.to_geodetic(vertex.position());
      place.height = origin.height;
      const Eigen::Vector3d p = enu.to_enu(place);
      road.x.push_back(p.x());
      road.y.push_back(p.y());
    }
  }
  return roads;
}

}  // namespace maploop::match
