#include "estimators/stereo/disparity_offset.h"

#include <cmath>

namespace maploop::stereo {

DisparityOffset::DisparityOffset(const StereoParameters& parameters)
    : sigma_(parameters.sigma_disparity_offset),
      drift_(parameters.disparity_offset_drift),
      worst_sigma_(parameters.max_offset_sigma),
      min_inliers_(parameters.min_offset_inliers) {}

void DisparityOffset::predict(double seconds) {
  if (sigma_ > 0.0) sigma_ = std::hypot(sigma_, drift_ * std::sqrt(seconds));
}

void DisparityOffset::update(double correction, double correction_sigma, int inliers) {
  if (sigma_ == 0.0 || inliers < min_inliers_ || !(correction_sigma <= worst_sigma_)) return;
  const double noise = correction_sigma * correction_sigma;
  const double variance = sigma_ * sigma_;
  if (!(correction * correction <= 9.0 * (variance + noise))) return;
  value_ += correction * variance / (variance + noise);  // (9) of METHOD.md
  sigma_ = std::sqrt(variance * noise / (variance + noise));
}

}  // namespace maploop::stereo
