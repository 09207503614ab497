#include "tools/match/doubt_pool.h"

#include <algorithm>
#include <cmath>

#include "mapmatch/doubt_collector.h"

namespace maploop::match {
namespace {

constexpr double near = 20.0;       // m between two tracks on one road
constexpr double near_share = 0.7;  // of the points of the shorter track

double distance_to_track(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& track) {
  double least = (p - track.front()).norm();
  for (std::size_t i = 1; i < track.size(); ++i) {
    const Eigen::Vector2d& a = track[i - 1];
    const Eigen::Vector2d along = track[i] - a;
    const double length = along.squaredNorm();
    const double share = length > 0.0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - share * along).norm());
  }
  return least;
}

bool same_ground(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  if (a.empty() || b.empty()) return false;
  const auto& fewer = a.size() < b.size() ? a : b;
  const auto& more = a.size() < b.size() ? b : a;
  const auto count = std::count_if(fewer.begin(), fewer.end(), [&](const Eigen::Vector2d& p) {
    return distance_to_track(p, more) < near;
  });
  return static_cast<double>(count) >= near_share * static_cast<double>(fewer.size());
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
      return same_ground(places(a), places(b));
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
  auto sums = std::find_if(all_.begin(), all_.end(),
                           [&](const Sums& s) { return same(s.pooled.doubt, doubt); });
  if (sums == all_.end()) sums = all_.insert(all_.end(), {{doubt, 0, {}}});
  PooledDoubt& pooled = sums->pooled;
  if (doubt.probability > pooled.doubt.probability) pooled.doubt = doubt;
  ++pooled.times;
  pooled.drives.insert(drive);
  sums->all_wrong *= 1.0 - doubt.probability;
  if (doubt.kind != DoubtKind::shifted_road) return;
  const double weight = 1.0 / (doubt.offset_sigma * doubt.offset_sigma);
  sums->weight += weight;
  sums->offset += weight * (doubt.from.link.forward ? doubt.offset : -doubt.offset);
}

PooledDoubt DoubtPool::total(const Sums& sums) const {
  PooledDoubt pooled = sums.pooled;
  MapDoubt& doubt = pooled.doubt;
  doubt.probability = 1.0 - sums.all_wrong;
  if (doubt.kind != DoubtKind::shifted_road) return pooled;
  const double offset = sums.offset / sums.weight;
  doubt.offset = doubt.from.link.forward ? offset : -offset;
  doubt.offset_sigma = 1.0 / std::sqrt(sums.weight);
  const auto& road = network_.road_at(network_.link(doubt.from.link.link).first_vertex);
  doubt.probability =
      mapmatch::probability_of_shift(offset, doubt.offset_sigma, mapmatch::half_width(road));
  return pooled;
}

std::vector<PooledDoubt> DoubtPool::likelier_than(double probability) const {
  std::vector<PooledDoubt> found;
  for (const Sums& sums : all_) {
    PooledDoubt pooled = total(sums);
    if (pooled.doubt.probability > probability) found.push_back(std::move(pooled));
  }
  std::stable_sort(found.begin(), found.end(), [](const PooledDoubt& a, const PooledDoubt& b) {
    return a.doubt.probability > b.doubt.probability;
  });
  return found;
}

}  // namespace maploop::match
