#include "tools/match/driven_streets.h"

#include <algorithm>

namespace maploop::match {
namespace {

using mapmatch::MatchResult;

// Returns the metres driven from one matched place to the next. On one link a place that goes back
// counts as negative, so that a vehicle that stands does not gather length.
double step(const MatchResult& before, const MatchResult& now, double max_gap) {
  if (to_seconds(now.stamp - before.stamp) > max_gap) return 0.0;
  if (before.link == now.link) return now.along - before.along;
  return (now.point.position - before.point.position).norm();
}

}  // namespace

std::string street_name(const mapmatch::Road& road) {
  return road.name.empty() ? "unnamed road (" + std::string(to_string(road.road_class)) + ")"
                           : road.name;
}

std::vector<DrivenStreet> driven_streets(const MatchedTrack& track,
                                         const mapmatch::RoadNetwork& network) {
  std::vector<DrivenStreet> streets;
  const MatchResult* before = nullptr;  // the fix before, if it is on a road
  for (const std::size_t i : track.used()) {
    const MatchResult& now = track.results[i];
    if (!now.on_road) {
      before = nullptr;
      continue;
    }
    const double second = track.second(i);
    const std::string name = street_name(network.road_at(now.point.vertex));
    if (!before || streets.back().name != name) streets.push_back({name, second});
    DrivenStreet& street = streets.back();
    street.to = second;
    if (before) street.length += step(*before, now, track.max_gap);
    street.probability += now.probability;
    ++street.fixes;
    before = &now;
  }
  for (DrivenStreet& street : streets) {
    street.probability /= static_cast<double>(street.fixes);
    street.length = std::max(street.length, 0.0);
  }
  return streets;
}

}  // namespace maploop::match
