#include "tools/match/baseline_matchers.h"

#include <algorithm>
#include <cmath>

#include "mapmatch/candidate_search.h"
#include "mapmatch/foot_point.h"
#include "msgs/frames.h"

namespace maploop::match {
namespace {

using mapmatch::DirectedLink;
using mapmatch::NearLink;
using mapmatch::RoadNetwork;

constexpr double search_reach = 100.0;  // m
constexpr double gate = radians(50.0);
constexpr double ellipse_margin = 12.0;  // m, for the error of the map and half a road's width

bool fits(double vehicle, double road) {
  return !(std::abs(wrap_angle(vehicle - road)) > gate);
}

bool meet(const RoadNetwork& network, std::uint32_t a, std::uint32_t b) {
  const mapmatch::Link &one = network.link(a), &other = network.link(b);
  return a == b || one.start_junction == other.start_junction ||
         one.start_junction == other.end_junction || one.end_junction == other.start_junction ||
         one.end_junction == other.end_junction;
}

// Returns the link in the direction, of those that the map allows, that is nearer to the azimuth.
DirectedLink directed(const RoadNetwork& network, const NearLink& near, double azimuth) {
  const DirectedLink link = near.link;
  if (!network.allowed(link.reversed())) return link;
  if (!network.allowed(link)) return link.reversed();
  const bool along = !(std::abs(wrap_angle(azimuth - near.point.azimuth())) > radians(90.0));
  return along ? link : link.reversed();
}

double azimuth_of(const NearLink& near, DirectedLink link) {
  return near.point.azimuth() + (link == near.link ? 0.0 : radians(180.0));
}

}  // namespace

std::vector<MatchedFix> nearest_segments(const RoadNetwork& network, const Track& track) {
  std::vector<MatchedFix> matched;
  for (const mapmatch::VehicleFix& fix : track) {
    const Eigen::Vector2d place = network.to_local(fix.position);
    MatchedFix best;
    double best_distance = search_reach;
    auto offer = [&](const mapmatch::IndexedSegment& s) {
      const Eigen::Vector2d a = network.vertex(s.vertex).position();
      const Eigen::Vector2d step = network.vertex(s.vertex + 1).position() - a;
      const double share = mapmatch::foot_share(place, a, step);
      const double distance = (place - a - share * step).norm();
      if (distance >= best_distance) return;
      for (const bool forward : {true, false}) {
        const double azimuth =
            forward ? std::atan2(step.x(), step.y()) : std::atan2(-step.x(), -step.y());
        if (!network.allowed({s.link, forward}) || !fits(fix.azimuth, azimuth)) continue;
        best_distance = distance;
        best = on_segment(network, {s.link, forward}, s.vertex, 1.0);
      }
    };
    network.index().visit({place.x() - search_reach, place.y() - search_reach,
                           place.x() + search_reach, place.y() + search_reach},
                          offer);
    matched.push_back(best);
  }
  return matched;
}

std::vector<MatchedFix> topological_weights(const RoadNetwork& network, const Track& track) {
  // The constants are Greenfeld's; a line between fixes needs a metre.
  constexpr double most = 10.0, per_metre = 0.1, distance_power = 1.2, least_line = 1.0;
  constexpr int azimuth_power = 5, crossing_power = 10;
  const mapmatch::ErrorEllipse region(Eigen::Matrix2d::Zero(), search_reach);
  mapmatch::NearLinks near;
  std::vector<MatchedFix> matched;
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  double azimuth = std::nan("");
  std::optional<DirectedLink> last;
  for (const mapmatch::VehicleFix& fix : track) {
    const Eigen::Vector2d place = network.to_local(fix.position);
    const Eigen::Vector2d line = place - before;
    if (!matched.empty() && line.norm() >= least_line) azimuth = std::atan2(line.x(), line.y());
    find_near_links(network, place, region, near);
    const auto meets_last = [&](const NearLink& n) {
      return last && meet(network, n.link.link, last->link);
    };
    const bool any = std::any_of(near.all().begin(), near.all().end(), meets_last);
    MatchedFix best;
    double best_weight = -1e9;
    for (const NearLink& n : near.all()) {
      if (any && !meets_last(n)) continue;
      const DirectedLink link = directed(network, n, azimuth);
      double weight = most - per_metre * std::pow(n.distance, distance_power);
      if (std::isfinite(azimuth)) {
        const double cosine = std::cos(wrap_angle(azimuth - azimuth_of(n, link)));
        weight += most * std::pow(cosine, azimuth_power);
        // The line between the fixes crosses the link if they are on both of its sides.
        const Eigen::Vector2d normal(n.point.direction.y(), -n.point.direction.x());
        const double side = normal.dot(place - n.point.position);
        if (side * normal.dot(before - n.point.position) < 0.0)
          weight += most * std::pow(std::abs(cosine), crossing_power);
      }
      if (weight <= best_weight) continue;
      best_weight = weight;
      best = on_segment(network, link, n.point.vertex, 1.0);
    }
    matched.push_back(best);
    last = best.link;
    before = place;
  }
  return matched;
}

std::vector<MatchedFix> probabilistic_ellipse(const RoadNetwork& network, const Track& track) {
  mapmatch::NearLinks near;
  std::vector<MatchedFix> matched;
  std::optional<DirectedLink> last;
  for (const mapmatch::VehicleFix& fix : track) {
    find_near_links(network, network.to_local(fix.position),
                    mapmatch::ErrorEllipse(fix.covariance, ellipse_margin), near);
    MatchedFix best;
    for (const NearLink& n : near.all()) {  // the nearest comes first
      const DirectedLink link = directed(network, n, fix.azimuth);
      if (!fits(fix.azimuth, azimuth_of(n, link))) continue;
      const bool meets_last = last && meet(network, link.link, last->link);
      if (!best.link || meets_last) best = on_segment(network, link, n.point.vertex, 1.0);
      if (meets_last) break;
    }
    matched.push_back(best);
    last = best.link;
  }
  return matched;
}

}  // namespace maploop::match
