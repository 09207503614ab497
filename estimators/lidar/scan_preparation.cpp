#include "estimators/lidar/scan_preparation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maploop::lidar {
namespace {

using Eigen::Vector3f;

// Returns atan(t) for t in [0, 1], to 1e-5 (Abramowitz and Stegun 4.4.49).
float arc_tangent(float t) {
  const float s = t * t;
  return t *
         (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
}

}  // namespace

Eigen::Isometry3d Twist::over(double seconds) const {
  const Eigen::Vector3d turn = rate * seconds;
  const double angle = turn.norm();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d V = Eigen::Matrix3d::Identity();
  if (angle > 1e-9) {
    const Eigen::Vector3d axis = turn / angle;
    Eigen::Matrix3d K;
    K << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    V += (1 - std::cos(angle)) / angle * K + (1 - std::sin(angle) / angle) * K * K;
    T.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  }
  T.translation() = V * velocity * seconds;  // (1) of METHOD.md
  return T;
}

Twist Twist::of(const Eigen::Isometry3d& T_before_after, double seconds) {
  const Eigen::AngleAxisd turn(T_before_after.linear());
  Twist twist;
  twist.rate = turn.axis() * (turn.angle() / seconds);
  // The translation is linear in the velocity.
  Eigen::Matrix3d V;
  for (int i = 0; i < 3; ++i) {
    V.col(i) = Twist{Eigen::Vector3d::Unit(i), twist.rate}.over(seconds).translation();
  }
  twist.velocity = V.inverse() * T_before_after.translation();
  return twist;
}

float turn_fraction(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay), smaller = std::min(ax, ay);
  float angle = arc_tangent(larger > 0.0f ? smaller / larger : 0.0f);
  constexpr float pi = std::numbers::pi_v<float>;
  angle = ay > ax ? 0.5f * pi - angle : angle;
  angle = x < 0.0f ? pi - angle : angle;
  angle = y < 0.0f ? -angle : angle;
  return std::clamp(0.5f - angle * (0.5f / pi), 0.0f, 1.0f);
}

PointTimes::PointTimes(const ScanView& scan, Time from)
    : scan_(scan),
      middle_(static_cast<float>(to_seconds(scan.stamp - from))),
      first_half_(static_cast<float>(to_seconds(scan.stamp - scan.start))),
      second_half_(static_cast<float>(to_seconds(scan.end - scan.stamp))) {}

float PointTimes::operator()(std::size_t i) const {
  if (scan_.times != nullptr) return middle_ + scan_.times[i];
  const Vector3f p = scan_[i];
  const float turn = 2.0f * turn_fraction(p.x(), p.y()) - 1.0f;
  return middle_ + turn * (turn < 0.0f ? first_half_ : second_half_);
}

Vector3f with_elevation(const Vector3f& point, float cosine, float sine) {
  const float range = std::sqrt(point.x() * point.x() + point.y() * point.y());
  if (!(range > 0.0f)) return point;
  const float scale = cosine - sine * point.z() / range;
  return {point.x() * scale, point.y() * scale, cosine * point.z() + sine * range};
}

ScanPreparation::ScanPreparation(const Eigen::Isometry3d& T_body_velo,
                                 const LidarParameters& parameters)
    : T_body_velo_(T_body_velo.cast<float>()),
      parameters_(parameters),
      moments_(static_cast<float>(parameters.sample_voxel), parameters.max_samples) {}

void ScanPreparation::prepare(const ScanView& scan, Time stamp, const Twist& motion,
                              PreparedScan* prepared) {
  prepared->stamp = stamp;
  prepared->cropped = 0;
  moments_.clear();

  const PointTimes time_of(scan, stamp);
  const Vector3f velocity = motion.velocity.cast<float>(), rate = motion.rate.cast<float>();
  const auto cosine = static_cast<float>(std::cos(parameters_.elevation_correction));
  const auto sine = static_cast<float>(std::sin(parameters_.elevation_correction));
  const auto nearest = static_cast<float>(parameters_.min_range * parameters_.min_range);
  const auto furthest = static_cast<float>(parameters_.max_range * parameters_.max_range);
  const std::size_t most = static_cast<std::size_t>(parameters_.max_points);
  const std::size_t stride = (scan.count + most - 1) / most;

  int left_out = 0;
  for (std::size_t i = 0; i < scan.count; i += stride) {
    const Vector3f raw = scan[i];
    const float square = raw.x() * raw.x() + raw.y() * raw.y() + raw.z() * raw.z();
    if (!(square >= nearest && square <= furthest)) {  // false for NaN too
      ++prepared->cropped;
      continue;
    }
    const float t = time_of(i);
    const Vector3f seen = T_body_velo_ * with_elevation(raw, cosine, sine);
    // This is the body's motion over t to second order; the third order is 0.2 mm at 80 m and 0.5
    // rad/s.
    // (2) of METHOD.md
    const Vector3f turned = t * rate.cross(seen + (0.5f * t) * (rate.cross(seen) + velocity));
    const float beam = raw.z() / std::sqrt(square);
    if (!moments_.add(seen + turned + t * velocity, beam)) ++left_out;
  }
  prepared->left_out =
      left_out +
      static_cast<int>(scan.count - (scan.count + stride - 1) / std::max<std::size_t>(stride, 1));
  moments_.sort();
  surface_points(moments_, T_body_velo_.translation(), parameters_, &prepared->points);
}

}  // namespace maploop::lidar
