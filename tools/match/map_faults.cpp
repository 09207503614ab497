#include "tools/match/map_faults.h"

#include <algorithm>
#include <utility>

namespace maploop::match {
namespace {

constexpr double sure = 0.9;

}  // namespace

mapmatch::NetworkData shifted(mapmatch::NetworkData network, const Eigen::Vector2d& metres) {
  for (mapmatch::Vertex& v : network.vertices) {
    v.east += metres.x();
    v.north += metres.y();
  }
  return network;
}

mapmatch::NetworkData one_way_reversed(mapmatch::NetworkData network) {
  for (mapmatch::Link& link : network.links) std::swap(link.forward, link.backward);
  return network;
}

mapmatch::NetworkData without_way(const mapmatch::MapExtract& map, std::int64_t way_id) {
  mapmatch::MapExtract less = map;
  std::erase_if(less.ways, [&](const mapmatch::MapWay& w) { return w.road.way_id == way_id; });
  return mapmatch::build_network(less);
}

FaultScore score_fault(const std::vector<MatchedFix>& matched, const Track& track,
                       const std::vector<std::size_t>& rows,
                       const std::map<std::size_t, Label>& labels, std::int64_t missing) {
  FaultScore score;
  double wrong_since = -1.0;
  double way = 0.0, right_again = -1.0;
  bool was_missing = false;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const auto label = labels.find(rows[i]);
    if (label == labels.end()) continue;
    const double t = to_seconds(track[i].stamp - track.front().stamp);
    if (i > 0) way += track[i].speed * to_seconds(track[i].stamp - track[i - 1].stamp);
    const bool is_missing = label->second.way_id == missing;
    const bool right = matched[i].way_id == label->second.way_id;
    if (was_missing && !is_missing) right_again = way;
    if (is_missing) {
      right_again = -1.0;
      ++score.missing_fixes;
      score.missing_said += matched[i].way_id ? 1 : 0;
      score.missing_sure += matched[i].way_id && matched[i].p_link > sure ? 1 : 0;
      score.missing_p_sum += matched[i].way_id ? matched[i].p_link : 0.0;
    }
    was_missing = is_missing;
    if (right_again >= 0.0) {
      score.recovery = std::max(score.recovery, way - right_again);
      if (right) right_again = -1.0;
    }
    if (matched[i].way_id && !right && matched[i].p_link > sure) {
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
