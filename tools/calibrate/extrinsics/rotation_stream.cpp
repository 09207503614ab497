#include "tools/calibrate/extrinsics/rotation_stream.h"

#include <algorithm>
#include <cstddef>

#include "msgs/small_turn.h"

namespace maploop::extrinsics {

using Eigen::Vector3d;

Vector3d SensorMotion::rate() const {
  return turn_of(T_from_to.linear()) / to_seconds(to - from);
}

std::vector<SensorMotion> joined(std::span<const SensorMotion> motions, double duration) {
  std::vector<SensorMotion> all;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    SensorMotion whole = motions[i];
    for (std::size_t k = i + 1;
         k < motions.size() && to_seconds(whole.to - whole.from) < duration &&
         motions[k].from == whole.to;
         ++k) {
      whole.T_from_to = whole.T_from_to * motions[k].T_from_to;
      whole.to = motions[k].to;
    }
    if (to_seconds(whole.to - whole.from) >= duration) all.push_back(whole);
  }
  return all;
}

RotationStream RotationStream::of_motions(std::span<const SensorMotion> motions) {
  RotationStream stream;
  if (motions.empty()) return stream;
  stream.origin_ = motions.front().from;
  Vector3d integral = Vector3d::Zero(), rate_before = Vector3d::Zero();
  double step_before = 0.0;
  for (const SensorMotion& m : motions) {
    const Vector3d rate = m.rate();
    const double begin = to_seconds(m.from - stream.origin_);
    const double step = to_seconds(m.to - m.from);
    std::vector<Knot>& knots = stream.knots_;
    if (knots.empty() || knots.back().t != begin) {
      knots.push_back({begin, integral, rate, knots.empty() ? 0 : knots.back().piece + 1});
    } else {
      // The slope of the parabola through three points.
      knots.back().rate = (step * rate_before + step_before * rate) / (step + step_before);
    }
    integral += step * rate;
    knots.push_back({begin + step, integral, rate, knots.back().piece});
    knots.back().t = to_seconds(m.to - stream.origin_);
    rate_before = rate;
    step_before = step;
  }
  return stream;
}

RotationStream RotationStream::of_rates(std::span<const RateSample> samples, bool vertical_alone,
                                        double longest_step) {
  RotationStream stream;
  stream.vertical_alone_ = vertical_alone;
  if (samples.empty()) return stream;
  stream.origin_ = samples.front().stamp;
  for (const RateSample& s : samples) {
    Knot knot{to_seconds(s.stamp - stream.origin_), Vector3d::Zero(), s.rate, 0};
    if (!stream.knots_.empty()) {
      const Knot& last = stream.knots_.back();
      knot.piece = last.piece + (knot.t - last.t > longest_step ? 1 : 0);
    }
    stream.knots_.push_back(knot);
  }
  std::vector<Knot>& k = stream.knots_;
  const auto slope = [&k](std::size_t i) -> Vector3d {
    const std::size_t a = i > 0 && k[i - 1].piece == k[i].piece ? i - 1 : i;
    const std::size_t b = i + 1 < k.size() && k[i + 1].piece == k[i].piece ? i + 1 : i;
    return a == b ? Vector3d(Vector3d::Zero())
                  : Vector3d((k[b].rate - k[a].rate) / (k[b].t - k[a].t));
  };
  for (std::size_t i = 1; i < k.size(); ++i) {
    const double h = k[i].t - k[i - 1].t;
    k[i].integral = k[i - 1].integral;
    if (k[i].piece != k[i - 1].piece) continue;
    k[i].integral +=
        0.5 * h * (k[i - 1].rate + k[i].rate) + h * h / 12.0 * (slope(i - 1) - slope(i));
  }
  return stream;
}

std::optional<RotationStream::Value> RotationStream::at(double t) const {
  auto after = std::ranges::upper_bound(knots_, t, {}, &Knot::t);
  if (after == knots_.end() && !knots_.empty() && knots_.back().t == t) --after;
  if (after == knots_.begin() || after == knots_.end()) return std::nullopt;
  const Knot &a = *(after - 1), &b = *after;
  if (a.piece != b.piece) return std::nullopt;
  const double h = b.t - a.t, x = (t - a.t) / h, y = 1.0 - x;
  return Value{y * y * (1.0 + 2.0 * x) * a.integral + x * x * (3.0 - 2.0 * x) * b.integral +
                   h * x * y * (y * a.rate - x * b.rate),
               a.piece};
}

std::optional<Vector3d> RotationStream::mean_rate(Time from, Time to, double shift) const {
  const auto a = at(to_seconds(from - origin_) + shift), b = at(to_seconds(to - origin_) + shift);
  if (!a || !b || a->piece != b->piece) return std::nullopt;
  return (b->integral - a->integral) / to_seconds(to - from);
}

}  // namespace maploop::extrinsics
