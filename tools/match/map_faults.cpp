#include "tools/match/map_faults.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "msgs/frames.h"

namespace maploop::match {
namespace {

// Returns whether the vehicle drove the way from its first node towards its last; nothing if it
// drove it both ways or not at all.
std::optional<bool> driven_forward(const mapmatch::MapWay& way, const Labels& labels) {
  std::set<bool> directions;
  for (const auto& [row, label] : labels) {
    if (label.way_id != way.road.way_id) continue;
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
      if (way.nodes[i] == label.node_a && way.nodes[i + 1] == label.node_b) directions.insert(true);
      if (way.nodes[i] == label.node_b && way.nodes[i + 1] == label.node_a)
        directions.insert(false);
    }
  }
  return directions.size() == 1 ? std::optional(*directions.begin()) : std::nullopt;
}

std::int64_t way_driven_longest(const Labels& labels) {
  std::map<std::int64_t, std::size_t> rows;
  for (const auto& [row, label] : labels) ++rows[label.way_id];
  return std::max_element(rows.begin(), rows.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

std::set<std::int64_t> driven_ways(const Labels& labels) {
  std::set<std::int64_t> ways;
  for (const auto& [row, label] : labels) ways.insert(label.way_id);
  return ways;
}

mapmatch::NetworkData shifted(mapmatch::NetworkData network, const Eigen::Vector2d& metres) {
  for (mapmatch::Vertex& v : network.vertices) {
    v.east += metres.x();
    v.north += metres.y();
  }
  return network;
}

mapmatch::NetworkData turned(mapmatch::NetworkData network, const Eigen::Vector2d& centre,
                             double angle) {
  const Eigen::Rotation2Dd clockwise(-angle);
  for (mapmatch::Vertex& v : network.vertices) {
    const Eigen::Vector2d p = centre + clockwise * (v.position() - centre);
    v.east = p.x();
    v.north = p.y();
  }
  return network;
}

mapmatch::NetworkData one_way_reversed(mapmatch::NetworkData network) {
  for (mapmatch::Link& link : network.links) std::swap(link.forward, link.backward);
  return network;
}

mapmatch::MapExtract with_parallels(const mapmatch::MapExtract& map,
                                    const std::set<std::int64_t>& ways, double metres) {
  mapmatch::MapExtract more = map;
  std::map<std::int64_t, Geodetic> nodes;
  std::int64_t next_id = 1, next_way = 1;
  for (const mapmatch::MapNode& node : map.nodes) {
    nodes[node.id] = {radians(node.latitude), radians(node.longitude), 0.0};
    next_id = std::max(next_id, node.id + 1);
  }
  for (const mapmatch::MapWay& way : map.ways) next_way = std::max(next_way, way.road.way_id + 1);
  for (const mapmatch::MapWay& way : map.ways) {
    if (!ways.contains(way.road.way_id) || way.nodes.size() < 2) continue;
    if (!std::all_of(way.nodes.begin(), way.nodes.end(),
                     [&](std::int64_t id) { return nodes.contains(id); }))
      continue;
    const LocalFrame frame(nodes[way.nodes.front()]);
    std::vector<Eigen::Vector2d> places;
    for (const std::int64_t id : way.nodes) places.emplace_back(frame.to_enu(nodes[id]).head<2>());
    mapmatch::MapWay beside = way;
    beside.road.way_id = next_way++;
    beside.nodes = {way.nodes.front()};
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector2d along =
          (places[std::min(i + 1, places.size() - 1)] - places[i > 0 ? i - 1 : 0]).normalized();
      const Eigen::Vector2d p = places[i] + metres * Eigen::Vector2d(along.y(), -along.x());
      const Geodetic g = frame.to_geodetic({p.x(), p.y(), 0.0});
      more.nodes.push_back({next_id, degrees(g.latitude), degrees(g.longitude)});
      beside.nodes.push_back(next_id++);
    }
    beside.nodes.push_back(way.nodes.back());
    more.ways.push_back(beside);
  }
  return more;
}

mapmatch::MapExtract direction_wrong(const mapmatch::MapExtract& map, const Labels& labels,
                                     std::int64_t way_id) {
  mapmatch::MapExtract wrong = map;
  for (mapmatch::MapWay& way : wrong.ways) {
    if (way.road.way_id != way_id) continue;
    const auto forward = driven_forward(way, labels);
    if (!forward) continue;
    way.road.forward = !*forward;
    way.road.backward = *forward;
  }
  return wrong;
}

mapmatch::MapExtract with_opposite_carriageways(const mapmatch::MapExtract& map,
                                                const Labels& labels, double metres) {
  mapmatch::MapExtract divided = map;
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    const auto forward = driven_forward(map.ways[i], labels);
    if (!forward) continue;
    const std::size_t before = divided.ways.size();
    divided = with_parallels(divided, {map.ways[i].road.way_id}, *forward ? -metres : metres);
    if (divided.ways.size() == before) continue;
    divided.ways[i].road.forward = divided.ways.back().road.backward = *forward;
    divided.ways[i].road.backward = divided.ways.back().road.forward = !*forward;
  }
  return divided;
}

mapmatch::NetworkData without_way(const mapmatch::MapExtract& map, std::int64_t way_id) {
  mapmatch::MapExtract less = map;
  std::erase_if(less.ways, [&](const mapmatch::MapWay& w) { return w.road.way_id == way_id; });
  return mapmatch::build_network(less);
}

mapmatch::NetworkData with_fault(const mapmatch::MapExtract& map, const Labels& labels,
                                 MapFault fault) {
  if (labels.empty() && (fault == MapFault::missing || fault == MapFault::parallel)) {
    throw std::runtime_error("--map-fault " + std::string(to_string(fault)) +
                             " needs labels of the roads driven, which are not there "
                             "(sensors/FORMATS.md); the other faults do not");
  }
  switch (fault) {
    case MapFault::missing:
      return without_way(map, way_driven_longest(labels));
    case MapFault::shifted_5:
      return shifted(mapmatch::build_network(map), {5.0, 0.0});
    case MapFault::shifted_10:
      return shifted(mapmatch::build_network(map), {10.0, 0.0});
    case MapFault::reversed:
      return one_way_reversed(mapmatch::build_network(map));
    case MapFault::parallel:
      break;
  }
  return mapmatch::build_network(with_parallels(map, driven_ways(labels), 12.0));
}

FaultScore score_fault(const std::vector<MatchedFix>& matched, const NoisyTrack& noisy,
                       const Labels& labels, std::int64_t missing) {
  constexpr double sure = 0.9;
  const Track& track = noisy.track;
  FaultScore score;
  double wrong_since = -1.0;
  double lost = 0.0;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const auto label = labels.find(noisy.rows[i]);
    if (label == labels.end()) continue;
    const MatchedFix& fix = matched[i];
    const double t = to_seconds(track[i].stamp - track.front().stamp);
    const bool is_missing = label->second.way_id == missing;
    const bool right = fix.way_id == label->second.way_id;
    const bool is_sure = fix.way_id && fix.p_link > sure;
    if (is_missing) {
      ++score.missing_fixes;
      score.missing_said += fix.way_id ? 1 : 0;
      score.missing_sure += is_sure ? 1 : 0;
      score.missing_p_sum += fix.way_id ? fix.p_link : 0.0;
    }
    lost = right || is_missing || i == 0
               ? 0.0
               : lost + track[i].speed * to_seconds(track[i].stamp - track[i - 1].stamp);
    score.recovery = std::max(score.recovery, lost);
    if (is_sure && !right) {
      if (wrong_since < 0.0) wrong_since = t;
      if (t - wrong_since > score.longest_sure_wrong) {
        score.longest_sure_wrong = t - wrong_since;
        score.worst_at = t;
      }
    } else {
      wrong_since = -1.0;
    }
  }
  return score;
}

DoubtScore score_doubts(const std::vector<MapDoubt>& doubts, const NoisyTrack& noisy,
                        const Labels& labels, std::int64_t way, bool is_missing) {
  const DoubtKind expected = is_missing ? DoubtKind::missing_road : DoubtKind::wrong_direction;
  DoubtScore score;
  for (const MapDoubt& doubt : doubts) {
    if (!(doubt.probability > 0.5)) continue;
    std::size_t during = 0, on_way = 0;
    for (std::size_t i = 0; i < noisy.track.size(); ++i) {
      const Time t = noisy.track[i].stamp;
      const auto label = labels.find(noisy.rows[i]);
      if (t < doubt.begin || t > doubt.stamp || label == labels.end()) continue;
      ++during;
      on_way += label->second.way_id == way ? 1 : 0;
    }
    const bool names_it =
        is_missing ? 2 * on_way >= during && on_way > 0 : doubt.from.way_id == way && on_way > 0;
    if (names_it && doubt.kind == expected) {
      score.found = true;
    } else {
      ++score.others;
    }
  }
  return score;
}

}  // namespace maploop::match
