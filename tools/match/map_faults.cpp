#include "tools/match/map_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "msgs/frames.h"

namespace maploop::match {

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

// A sum of plane waves whose wave vectors are normally distributed has a Gaussian correlation.
mapmatch::NetworkData bent(mapmatch::NetworkData network, double metres, double length,
                           std::uint64_t seed) {
  constexpr std::size_t waves = 64;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  struct Wave {
    Eigen::Vector2d vector, phases;
  };
  std::array<Wave, waves> all;
  for (Wave& wave : all) {
    wave.vector = Eigen::Vector2d(normal(random), normal(random)) / length;
    wave.phases = {phase(random), phase(random)};
  }
  const double amplitude = metres * std::sqrt(2.0 / static_cast<double>(waves));
  for (mapmatch::Vertex& v : network.vertices) {
    Eigen::Vector2d off(0.0, 0.0);
    for (const Wave& wave : all) {
      const double along = wave.vector.x() * v.east + wave.vector.y() * v.north;
      off += amplitude * (wave.phases.array() + along).cos().matrix();
    }
    v.east += off.x();
    v.north += off.y();
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

mapmatch::NetworkData without_way(const mapmatch::MapExtract& map, std::int64_t way_id) {
  mapmatch::MapExtract less = map;
  std::erase_if(less.ways, [&](const mapmatch::MapWay& w) { return w.road.way_id == way_id; });
  return mapmatch::build_network(less);
}

FaultScore score_fault(const std::vector<MatchedFix>& matched, const NoisyTrack& noisy,
                       const Labels& labels, std::int64_t missing) {
  constexpr double sure = 0.9;
  const Track& track = noisy.track;
  FaultScore score;
  double wrong_since = -1.0;
  double way = 0.0, right_again = -1.0;
  bool was_missing = false;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const auto label = labels.find(noisy.rows[i]);
    if (label == labels.end()) continue;
    const MatchedFix& fix = matched[i];
    const double t = to_seconds(track[i].stamp - track.front().stamp);
    if (i > 0) way += track[i].speed * to_seconds(track[i].stamp - track[i - 1].stamp);
    const bool is_missing = label->second.way_id == missing;
    const bool right = fix.way_id == label->second.way_id;
    const bool is_sure = fix.way_id && fix.p_link > sure;
    if (was_missing && !is_missing) right_again = way;
    if (is_missing) {
      right_again = -1.0;
      ++score.missing_fixes;
      score.missing_said += fix.way_id ? 1 : 0;
      score.missing_sure += is_sure ? 1 : 0;
      score.missing_p_sum += fix.way_id ? fix.p_link : 0.0;
    }
    was_missing = is_missing;
    if (right_again >= 0.0) {
      score.recovery = std::max(score.recovery, way - right_again);
      if (right) right_again = -1.0;
    }
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

}  // namespace maploop::match
