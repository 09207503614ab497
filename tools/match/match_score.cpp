#include "tools/match/match_score.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::match {
namespace {

constexpr double search_reach = 100.0;  // m
constexpr double gate = radians(50.0);  // for the baseline

MatchedFix on_segment(const mapmatch::RoadNetwork& network, mapmatch::DirectedLink link,
                      std::uint32_t vertex, double p) {
  const auto [a, b] = network.nodes(link, vertex);
  return {network.road_at(vertex).way_id, a, b, p, link};
}

}  // namespace

void MatchScore::add(const std::vector<MatchedFix>& matched, const std::vector<std::size_t>& rows,
                     const std::map<std::size_t, Label>& labels) {
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const auto label = labels.find(rows[i]);
    if (label == labels.end()) continue;
    const bool right = matched[i].way_id == label->second.way_id;
    const auto count = [&](Tally& tally) {
      ++tally.fixes;
      tally.matched += matched[i].way_id ? 1 : 0;
      tally.right += right ? 1 : 0;
    };
    count(all);
    if (label->second.certain) count(certain);
    if (!matched[i].way_id) continue;
    const auto bin = std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * matched[i].p_link));
    ++reliability.fixes[bin];
    const auto& driven = label->second.link;
    const bool same = driven && matched[i].link ? driven == matched[i].link : right;
    reliability.right[bin] += same ? 1 : 0;
    reliability.p_sum[bin] += matched[i].p_link;
  }
}

MatchedFix matched_fix(const mapmatch::MatchResult& r, const mapmatch::RoadNetwork& network) {
  if (!r.on_road || r.refusal != mapmatch::FixRefusal::none) return {};
  return on_segment(network, r.link, r.point.vertex, r.probability);
}

std::vector<MatchedFix> match_track(mapmatch::Matcher& matcher, const Track& track) {
  std::vector<MatchedFix> matched;
  for (const mapmatch::VehicleFix& fix : track)
    matched.push_back(matched_fix(matcher.add(fix), matcher.network()));
  return matched;
}

std::vector<MatchedFix> nearest_segments(const mapmatch::RoadNetwork& network, const Track& track) {
  std::vector<MatchedFix> matched;
  for (const mapmatch::VehicleFix& fix : track) {
    const Eigen::Vector2d place = network.to_local(fix.position);
    MatchedFix best;
    double best_distance = search_reach;
    network.index().visit(
        {place.x() - search_reach, place.y() - search_reach, place.x() + search_reach,
         place.y() + search_reach},
        [&](const mapmatch::IndexedSegment& s) {
          const Eigen::Vector2d a = network.vertex(s.vertex).position();
          const Eigen::Vector2d step = network.vertex(s.vertex + 1).position() - a;
          const double share =
              std::clamp((place - a).dot(step) / std::max(step.squaredNorm(), 1e-9), 0.0, 1.0);
          const double distance = (place - a - share * step).norm();
          if (distance >= best_distance) return;
          for (const bool forward : {true, false}) {
            if (!network.allowed({s.link, forward})) continue;
            const double azimuth =
                forward ? std::atan2(step.x(), step.y()) : std::atan2(-step.x(), -step.y());
            if (std::abs(wrap_angle(fix.azimuth - azimuth)) > gate) continue;
            best_distance = distance;
            best = on_segment(network, {s.link, forward}, s.vertex, 1.0);
          }
        });
    matched.push_back(best);
  }
  return matched;
}

}  // namespace maploop::match
