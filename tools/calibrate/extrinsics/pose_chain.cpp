#include "tools/calibrate/extrinsics/pose_chain.h"

#include <algorithm>

namespace maploop::extrinsics {

using Eigen::Isometry3d, Eigen::Vector3d;

PoseChain::PoseChain(std::span<const SensorMotion> motions) {
  if (motions.empty()) return;
  origin_ = motions.front().from;
  for (const SensorMotion& m : motions) {
    const double begin = to_seconds(m.from - origin_), end = to_seconds(m.to - origin_);
    if (knots_.empty() || knots_.back().t != begin) {
      knots_.push_back({begin, Isometry3d::Identity(), m.T_from_to.translation() / (end - begin),
                        knots_.empty() ? 0 : knots_.back().piece + 1});
    }
    Knot& last = knots_.back();
    const Vector3d mean = last.pose.linear() * m.T_from_to.translation() / (end - begin);
    const bool inside = knots_.size() > 1 && (knots_.end() - 2)->piece == last.piece;
    if (inside) {
      const Knot& first = *(knots_.end() - 2);
      const double step = last.t - first.t;
      const Vector3d mean_before = (last.pose.translation() - first.pose.translation()) / step;
      last.velocity = ((end - begin) * mean_before + step * mean) / (end - begin + step);
    } else {
      last.velocity = mean;
    }
    knots_.push_back({end, last.pose * m.T_from_to, mean, last.piece});
  }
}

const PoseChain::Knot* PoseChain::before(double t) const {
  const auto after = std::ranges::upper_bound(knots_, t, {}, &Knot::t);
  if (after == knots_.begin() || after == knots_.end()) return nullptr;
  return (after - 1)->piece == after->piece ? &*(after - 1) : nullptr;
}

Isometry3d PoseChain::between(const Knot& a, const Knot& b, double t) {
  const double h = b.t - a.t, x = (t - a.t) / h, y = 1.0 - x;
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(a.pose.linear())
                      .slerp(x, Eigen::Quaterniond(b.pose.linear()))
                      .toRotationMatrix();
  pose.translation() = y * y * (1.0 + 2.0 * x) * a.pose.translation() +
                       x * x * (3.0 - 2.0 * x) * b.pose.translation() +
                       h * x * y * (y * a.velocity - x * b.velocity);
  return pose;
}

std::optional<Isometry3d> PoseChain::motion(Time from, Time to, double shift) const {
  const double begin = to_seconds(from - origin_) + shift, end = to_seconds(to - origin_) + shift;
  const Knot *a = before(begin), *b = before(end);
  if (a == nullptr || b == nullptr || a->piece != b->piece) return std::nullopt;
  return between(*a, *(a + 1), begin).inverse() * between(*b, *(b + 1), end);
}

}  // namespace maploop::extrinsics
