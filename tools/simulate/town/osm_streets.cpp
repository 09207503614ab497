// Reads the streets to simulate a drive on from an OpenStreetMap file.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "msgs/frames.h"
#include "tools/simulate/town/site.h"

namespace maploop::simulate {
namespace {

constexpr double spacing = 2.0;           // m, between points of a centreline
constexpr double one_junction = 18.0;     // m; the ends of a shorter street are one junction
constexpr int corner_smoothing = 12;      // passes of (1 2 1) / 4: corners are rounded over 5 m
constexpr double fastest_allowed = 27.8;  // m/s

struct Piece {
  const mapmatch::MapWay* way;
  std::size_t from, to;  // indices of nodes
  Line line;
};

bool is_drivable(const mapmatch::Road& road) {
  using mapmatch::RoadClass;
  return !road.restricted && !road.tunnel && (road.forward || road.backward) &&
         road.road_class != RoadClass::service && road.road_class != RoadClass::track;
}

// Splits the ways where they meet.
std::vector<Piece> pieces_of(const mapmatch::MapExtract& map, const LocalFrame& frame,
                             std::vector<Eigen::Vector2d>& places) {
  std::map<std::int64_t, std::size_t> number;
  for (const mapmatch::MapNode& node : map.nodes) {
    number[node.id] = places.size();
    places.push_back(
        frame.to_enu({radians(node.latitude), radians(node.longitude), frame.origin().height})
            .head<2>());
  }
  std::vector<int> uses(places.size(), 0);
  const auto known = [&](const mapmatch::MapWay& way) {
    return is_drivable(way.road) &&
           std::all_of(way.nodes.begin(), way.nodes.end(),
                       [&](std::int64_t id) { return number.contains(id); });
  };
  for (const mapmatch::MapWay& way : map.ways) {
    if (!known(way)) continue;
    for (const std::int64_t id : way.nodes) ++uses[number.at(id)];
    ++uses[number.at(way.nodes.front())];
    ++uses[number.at(way.nodes.back())];
  }
  std::vector<Piece> pieces;
  for (const mapmatch::MapWay& way : map.ways) {
    if (!known(way)) continue;
    Piece piece{&way, number.at(way.nodes.front()), 0, {}};
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
      const std::size_t node = number.at(way.nodes[i]);
      piece.line.push_back(places[node]);
      if (i == 0 || uses[node] < 2) continue;
      piece.to = node;
      pieces.push_back(piece);
      piece.from = node;
      piece.line = {places[node]};
    }
  }
  return pieces;
}

double length_of(const Line& line) {
  return distances_along(line).back();
}

// Returns evenly spaced points; the ends are at their junctions, and corners are rounded.
Line rounded(Line line, const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  line.front() = begin;
  line.back() = end;
  const double length = length_of(line);
  const auto steps = std::max(2, static_cast<int>(length / spacing));
  Line even{begin};
  std::size_t at = 1;
  double passed = 0.0;
  for (int i = 1; i < steps; ++i) {
    const double along = length * i / steps;
    while (passed + (line[at] - line[at - 1]).norm() < along && at + 1 < line.size()) {
      passed += (line[at] - line[at - 1]).norm();
      ++at;
    }
    const Eigen::Vector2d way = line[at] - line[at - 1];
    even.push_back(line[at - 1] + way * ((along - passed) / std::max(1e-6, way.norm())));
  }
  even.push_back(end);
  smooth(even, corner_smoothing);
  return even;
}

// Gives nodes of the same junction the same number (union-find).
class Merged {
 public:
  explicit Merged(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t operator()(std::size_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  void join(std::size_t a, std::size_t b) { parent_[(*this)(a)] = (*this)(b); }

 private:
  std::vector<std::size_t> parent_;
};

double usual_limit(const mapmatch::Road& road) {
  using mapmatch::RoadClass;
  if (road.speed_limit > 0.0) return road.speed_limit;
  switch (road.road_class) {
    case RoadClass::motorway:
    case RoadClass::trunk:
      return 27.8;
    case RoadClass::primary:
    case RoadClass::secondary:
      return 16.7;
    case RoadClass::tertiary:
      return 13.9;
    default:
      return 11.1;
  }
}

}  // namespace

Streets streets_of(const mapmatch::MapExtract& map, const LocalFrame& frame) {
  std::vector<Eigen::Vector2d> places;
  const std::vector<Piece> pieces = pieces_of(map, frame, places);
  Merged merged(places.size());
  for (const Piece& piece : pieces)
    if (length_of(piece.line) < one_junction) merged.join(piece.from, piece.to);
  std::map<std::size_t, std::pair<Eigen::Vector2d, double>> sums;
  for (const Piece& piece : pieces)
    for (const std::size_t node : {piece.from, piece.to}) {
      auto& [sum, count] =
          sums.try_emplace(merged(node), Eigen::Vector2d::Zero(), 0.0).first->second;
      sum += places[node];
      count += 1.0;
    }
  Streets streets;
  std::map<std::size_t, std::size_t> junction;
  for (const auto& [node, sum] : sums) {
    junction[node] = streets.junctions.size();
    streets.junctions.push_back(sum.first / sum.second);
  }
  for (const Piece& piece : pieces) {
    Street street;
    street.from = junction.at(merged(piece.from));
    street.to = junction.at(merged(piece.to));
    if (street.from == street.to) continue;
    street.centreline =
        rounded(piece.line, streets.junctions[street.from], streets.junctions[street.to]);
    const mapmatch::Road& road = piece.way->road;
    street.half_width = std::clamp(mapmatch::half_width(road), 2.75, 7.0);
    street.speed_limit = std::min(fastest_allowed, usual_limit(road));
    street.forward = road.forward;
    street.backward = road.backward;
    street.along = distances_along(street.centreline);
    streets.streets.push_back(std::move(street));
  }
  return streets;
}

}  // namespace maploop::simulate
