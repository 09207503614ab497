#include "mapmatch/lanes.h"

#include <cmath>

namespace maploop::mapmatch {
namespace {

struct LaneCounts {
  int forward = 0, backward = 0;
};

// Returns the lanes of each direction; none if they are not known.
LaneCounts lane_counts(const Road& road) {
  const bool two_way = road.forward && road.backward;
  const int all = road.lanes;
  LaneCounts counts{road.lanes_forward, road.lanes_backward};
  if (two_way && counts.forward == 0 && counts.backward == 0) {
    if (all % 2 != 0) return {};
    counts = {all / 2, all / 2};
  } else if (all > 0) {
    // A one-way road may have lanes of buses against it, which are tagged.
    if (counts.forward == 0 && road.forward) counts.forward = all - counts.backward;
    if (counts.backward == 0 && road.backward) counts.backward = all - counts.forward;
    if (counts.forward + counts.backward != all) return {};
  }
  const bool known =
      (!road.forward || counts.forward > 0) && (!road.backward || counts.backward > 0);
  return known ? counts : LaneCounts{};
}

}  // namespace

Lanes lanes_of(const Road& road, bool forward, bool left_hand_traffic) {
  const LaneCounts counts = lane_counts(road);
  const int own = forward ? counts.forward : counts.backward;
  const int opposite = forward ? counts.backward : counts.forward;
  if (own == 0 || !(forward ? road.forward : road.backward)) return {};
  const int all = own + opposite;
  const double width = road.width > 0.0 ? road.width : all * usual_lane_width(road);
  Lanes lanes{own, width / all, -0.5 * width};
  if (!left_hand_traffic) lanes.left += opposite * lanes.width;
  return lanes;
}

LanePosition lane_at(const Lanes& lanes, double cross_track, double sigma) {
  LanePosition best;
  best.lanes = lanes.count;
  const auto squared = [&](int lane) {
    return std::pow((cross_track - lanes.middle(lane)) / sigma, 2);
  };
  for (int lane = 1; lane <= lanes.count; ++lane)
    if (best.lane == 0 || squared(lane) < squared(best.lane)) best.lane = lane;
  if (best.lane == 0) return best;
  double sum = 0.0;
  for (int lane = 1; lane <= lanes.count; ++lane)
    sum += std::exp(0.5 * (squared(best.lane) - squared(lane)));
  best.probability = 1.0 / sum;
  best.offset = cross_track - lanes.middle(best.lane);
  return best;
}

LanePosition lane_on(const RoadNetwork& network, DirectedLink link, const LinkPoint& point,
                     const Eigen::Vector2d& place, const Eigen::Matrix2d& covariance,
                     double line_sigma) {
  const bool along_way = link.forward == network.vertex(point.vertex).along_way;
  const Lanes lanes =
      lanes_of(network.road_at(point.vertex), along_way, network.left_hand_traffic());
  const Eigen::Vector2d right(point.direction.y(), -point.direction.x());
  return lane_at(lanes, right.dot(place - point.position),
                 std::sqrt(right.dot(covariance * right) + line_sigma * line_sigma));
}

}  // namespace maploop::mapmatch
