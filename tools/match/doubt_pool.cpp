#include "tools/match/doubt_pool.h"

#include <algorithm>
#include <cmath>

#include "mapmatch/doubt_collector.h"
#include "mapmatch/foot_point.h"

namespace maploop::match {
namespace {

constexpr double near = 20.0;       // m between two tracks on one road
constexpr double near_share = 0.7;  // of the points of the shorter track

double distance_to_track(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& track) {
  double least = (p - track.front()).norm();
  for (std::size_t i = 1; i < track.size(); ++i) {
    const Eigen::Vector2d& a = track[i - 1];
    const Eigen::Vector2d along = track[i] - a;
    least = std::min(least, (p - a - mapmatch::foot_share(p, a, along) * along).norm());
  }
  return least;
}

bool same_ground(const std::vector<Eigen::Vector2d>& shorter,
                 const std::vector<Eigen::Vector2d>& longer) {
  if (shorter.empty() || longer.empty()) return false;
  const auto count = std::count_if(shorter.begin(), shorter.end(), [&](const Eigen::Vector2d& p) {
    return distance_to_track(p, longer) < near;
  });
  return static_cast<double>(count) >= near_share * static_cast<double>(shorter.size());
}

}  // namespace

bool DoubtPool::same(const MapDoubt& a, const MapDoubt& b) const {
  if (a.kind != b.kind) return false;
  const auto places = [&](const MapDoubt& doubt) {
    std::vector<Eigen::Vector2d> track;
    for (std::size_t i = 0; i < doubt.track_count; ++i)
      track.push_back(network_.to_local(doubt.track[i]));
    return track;
  };
  switch (a.kind) {
    case DoubtKind::missing_road:
      return a.length < b.length ? same_ground(places(a), places(b))
                                 : same_ground(places(b), places(a));
    case DoubtKind::wrong_direction:
      return a.from.link == b.from.link;
    case DoubtKind::forbidden_turn:
      return a.from.link == b.from.link && a.to.link == b.to.link;
    case DoubtKind::shifted_road:
      break;
  }
  return a.from.link.link == b.from.link.link;
}

void DoubtPool::add(const MapDoubt& doubt, const std::string& drive) {
  const bool is_shift = doubt.kind == DoubtKind::shifted_road;
  if (!is_shift && !(doubt.probability > 0.5)) return;
  auto group = std::find_if(all_.begin(), all_.end(),
                            [&](const Group& g) { return same(g.pooled.doubt, doubt); });
  if (group == all_.end()) group = all_.insert(group, Group{{doubt, 0, {}}, {}});
  PooledDoubt& pooled = group->pooled;
  const bool shows_more = doubt.kind == DoubtKind::missing_road
                              ? doubt.length > pooled.doubt.length
                              : doubt.probability > pooled.doubt.probability;
  if (shows_more) pooled.doubt = doubt;
  ++pooled.times;
  pooled.drives.insert(drive);
  MapDoubt& of_drive = group->of_drive.try_emplace(drive, doubt).first->second;
  if (is_shift ? doubt.length > of_drive.length : doubt.probability > of_drive.probability)
    of_drive = doubt;
}

PooledDoubt DoubtPool::total(const Group& group) const {
  PooledDoubt pooled = group.pooled;
  MapDoubt& doubt = pooled.doubt;
  double all_wrong = 1.0;
  double weights = 0.0, offset = 0.0;  // 1/m^2; 1/m, to the right of the link's own direction
  for (const auto& [drive, one] : group.of_drive) {
    all_wrong *= 1.0 - one.probability;
    const double weight = 1.0 / (one.offset_sigma * one.offset_sigma);
    weights += weight;
    offset += weight * (one.from.link.forward ? one.offset : -one.offset);
  }
  doubt.probability = 1.0 - all_wrong;
  if (doubt.kind != DoubtKind::shifted_road) return pooled;
  offset /= weights;
  doubt.offset = doubt.from.link.forward ? offset : -offset;
  doubt.offset_sigma = 1.0 / std::sqrt(weights);
  const auto& road = network_.road_at(network_.link(doubt.from.link.link).first_vertex);
  doubt.probability =
      mapmatch::probability_of_shift(offset, doubt.offset_sigma, mapmatch::half_width(road));
  return pooled;
}

std::vector<PooledDoubt> DoubtPool::likelier_than(double probability) const {
  std::vector<PooledDoubt> found;
  for (const Group& group : all_) {
    PooledDoubt pooled = total(group);
    if (pooled.doubt.probability > probability) found.push_back(std::move(pooled));
  }
  std::stable_sort(found.begin(), found.end(), [](const PooledDoubt& a, const PooledDoubt& b) {
    return a.doubt.probability > b.doubt.probability;
  });
  return found;
}

}  // namespace maploop::match
