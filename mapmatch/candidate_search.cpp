#include "mapmatch/candidate_search.h"

#include <algorithm>
#include <cmath>

#include "mapmatch/foot_point.h"

namespace maploop::mapmatch {
namespace {

constexpr double expansion = 3.03;  // scale of the one-sigma ellipse for 99 %

NearLink nearest_on_segment(const RoadNetwork& network, const IndexedSegment& segment,
                            const Eigen::Vector2d& place) {
  const Vertex& a = network.vertex(segment.vertex);
  const Vertex& b = network.vertex(segment.vertex + 1);
  const Eigen::Vector2d step = b.position() - a.position();
  const double squared = step.squaredNorm();
  const double share = foot_share(place, a.position(), step);
  NearLink near;
  near.link = {segment.link, true};
  near.along = a.along + share * (b.along - a.along);
  near.point.position = a.position() + share * step;
  near.point.direction =
      squared > 0.0 ? Eigen::Vector2d(step / std::sqrt(squared)) : Eigen::Vector2d::UnitX();
  near.point.vertex = segment.vertex;
  near.distance = (place - near.point.position).norm();
  return near;
}

void keep(NearLinks& near, const NearLink& candidate) {
  auto* const begin = near.links.data();
  auto* end = begin + near.count;
  auto* same = std::find_if(begin, end,
                            [&](const NearLink& n) { return n.link.link == candidate.link.link; });
  if (same != end) {
    if (same->distance <= candidate.distance) return;
  } else if (near.count < NearLinks::capacity) {
    same = end;
    ++near.count;
  } else {
    ++near.left_out;
    same = end - 1;
    if (same->distance <= candidate.distance) return;
  }
  while (same != begin && (same - 1)->distance > candidate.distance) {
    *same = *(same - 1);
    --same;
  }
  *same = candidate;
}

}  // namespace

ErrorEllipse::ErrorEllipse(const Eigen::Matrix2d& covariance, double margin) {
  const double x = covariance(0, 0), y = covariance(1, 1), xy = covariance(0, 1);
  const double root = std::sqrt((x - y) * (x - y) + 4.0 * xy * xy);
  major = expansion * std::sqrt(0.5 * (x + y + root)) + margin;
  minor = expansion * std::sqrt(std::max(0.0, 0.5 * (x + y - root))) + margin;
  const double angle = 0.5 * std::atan2(2.0 * xy, x - y);  // from east
  direction = {std::cos(angle), std::sin(angle)};
}

bool ErrorEllipse::contains(const Eigen::Vector2d& offset) const {
  const double along = offset.dot(direction) / major;
  const double across = (offset.x() * direction.y() - offset.y() * direction.x()) / minor;
  return along * along + across * across <= 1.0;
}

Box ErrorEllipse::box(const Eigen::Vector2d& center) const {
  const Eigen::Vector2d half(std::hypot(major * direction.x(), minor * direction.y()),
                             std::hypot(major * direction.y(), minor * direction.x()));
  return {center.x() - half.x(), center.y() - half.y(), center.x() + half.x(),
          center.y() + half.y()};
}

void find_near_links(const RoadNetwork& network, const Eigen::Vector2d& place,
                     const ErrorEllipse& region, NearLinks& near) {
  near.count = 0;
  near.left_out = 0;
  network.index().visit(region.box(place), [&](const IndexedSegment& segment) {
    const NearLink candidate = nearest_on_segment(network, segment, place);
    if (region.contains(candidate.point.position - place)) keep(near, candidate);
  });
}

}  // namespace maploop::mapmatch
