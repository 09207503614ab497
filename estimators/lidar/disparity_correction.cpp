#include "estimators/lidar/disparity_correction.h"

#include <algorithm>
#include <cmath>

namespace maploop::lidar {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double blind = 3.0;  // px; a motion with a larger sigma of the offset is ignored

}  // namespace

DisparityCorrection::DisparityCorrection(const LidarParameters& parameters)
    : wanted_(parameters.correct_disparities),
      drift_(parameters.disparity_drift),
      least_sigma_(parameters.min_disparity_sigma) {}

RelativeMotion DisparityCorrection::correct(const VisualMotion& visual) const {
  RelativeMotion corrected = visual;
  if (motions_ == 0 || visual.status != OdometryStatus::ok) return corrected;
  const Vector6 change = (offset_ - visual.offset) * visual.by_offset;
  corrected.translation += change.head<3>();
  const double angle = change.tail<3>().norm();
  if (angle > 0.0) {
    corrected.rotation =
        (Eigen::AngleAxisd(angle, change.tail<3>() / angle) * visual.rotation).normalized();
  }
  const double less = visual.offset_sigma * visual.offset_sigma - sigma_ * sigma_;
  if (less > 0.0) corrected.covariance -= less * visual.by_offset * visual.by_offset.transpose();
  return corrected;
}

// This is a Kalman filter with one state. Its innovation is limited to three standard deviations.
void DisparityCorrection::learn(const VisualMotion& visual, const LidarMotion& lidar) {
  const bool determined =
      (lidar.degenerate & 1u << static_cast<unsigned>(MotionDirection::along)) == 0;
  if (!wanted_ || visual.status != OdometryStatus::ok || lidar.status != OdometryStatus::ok ||
      visual.from != lidar.from || visual.stamp != lidar.stamp || !determined) {
    return;
  }
  // Only the direction of travel is used: errors of the sensors' mountings cause differences
  // across.
  const Eigen::Vector3d along_way = visual.translation.normalized();
  const double by_offset = along_way.dot(visual.by_offset.head<3>());  // m / px
  const double own = visual.offset_sigma * visual.offset_sigma;
  const Eigen::Matrix3d covariance =
      visual.covariance.topLeftCorner<3, 3>() + lidar.covariance.topLeftCorner<3, 3>();
  const double noise = along_way.dot(covariance * along_way) - own * by_offset * by_offset;
  const double longer = along_way.dot(lidar.translation - visual.translation);  // m
  const double variance_of_one = noise / (by_offset * by_offset);               // px^2
  if (!(noise > 0.0 && variance_of_one < blind * blind) || !std::isfinite(longer)) return;
  const double measured = visual.offset + longer / by_offset;  // (9) of METHOD.md

  double variance = sigma_ * sigma_;
  if (motions_++ == 0) {
    offset_ = visual.offset;
    variance = std::max(own, least_sigma_ * least_sigma_);
  } else {
    variance += drift_ * drift_ * std::max(0.0, to_seconds(visual.stamp - last_));
  }
  const double limit = 3.0 * std::sqrt(variance + variance_of_one);
  const double gain = variance / (variance + variance_of_one);
  offset_ += gain * std::clamp(measured - offset_, -limit, limit);
  sigma_ = std::max(std::sqrt((1.0 - gain) * variance), least_sigma_);
  last_ = visual.stamp;
}

}  // namespace maploop::lidar
