#include "estimators/stereo/validate.h"

#include <stdexcept>
#include <string>

#include "estimators/stereo/window.h"

namespace maploop::stereo {
namespace {

void require(bool holds, const char* what, const char* must, double value) {
  if (!holds)
    throw std::invalid_argument("stereo odometry: " + std::string(what) + " must be " + must +
                                ", not " + std::to_string(value));
}

void require_positive(const char* what, double value) {
  require(value > 0.0, what, "positive", value);
}

}  // namespace

void validate(const StereoCalibration& calibration) {
  const double smallest = 64.0;  // below this no pyramid of the default height
  require(calibration.width >= smallest, "calibration width", "at least 64 px", calibration.width);
  require(calibration.height >= smallest, "calibration height", "at least 64 px",
          calibration.height);
  require_positive("calibration fx", calibration.fx);
  require_positive("calibration fy", calibration.fy);
  require_positive("calibration baseline (m, right camera to the right)", calibration.baseline);
}

void validate(const StereoParameters& p) {
  require_positive("assumed_speed", p.assumed_speed);
  require_positive("sift_features", p.sift_features);
  require(p.sift_ratio > 0.0 && p.sift_ratio <= 1.0, "sift_ratio", "above 0, at most 1",
          p.sift_ratio);
  require(p.motion != MotionMethod::image_to_image || p.window_frames == 0, "window_frames",
          "0 with motion \"2d-2d\", which has no scale", p.window_frames);
  require(p.standstill_flow >= 0.0, "standstill_flow", "0 px or more", p.standstill_flow);
  require(p.dark_level >= 0.0, "dark_level", "0 or more", p.dark_level);
  require(p.bucket_size >= 8, "bucket_size", "at least 8 px", p.bucket_size);
  require_positive("features_per_bucket", p.features_per_bucket);
  require(p.fast_threshold >= 1 && p.fast_threshold < 255, "fast_threshold", "1 to 254",
          p.fast_threshold);
  require(p.min_feature_distance >= 0, "min_feature_distance", "0 px or more",
          p.min_feature_distance);
  require(p.window >= 5 && p.window <= 51 && p.window % 2 == 1, "window", "odd, 5 to 51 px",
          p.window);
  require(p.pyramid_levels >= 1 && p.pyramid_levels <= 6, "pyramid_levels", "1 to 6",
          p.pyramid_levels);
  require(p.predicted_levels >= 0 && p.predicted_levels <= p.pyramid_levels, "predicted_levels",
          "0 to pyramid_levels", p.predicted_levels);
  require_positive("max_iterations", p.max_iterations);
  require_positive("min_step", p.min_step);
  require_positive("min_disparity", p.min_disparity);
  require(p.max_disparity > p.min_disparity, "max_disparity", "above min_disparity",
          p.max_disparity);
  require_positive("max_row_error", p.max_row_error);
  require_positive("max_closure", p.max_closure);
  require_positive("sigma_track", p.sigma_track);
  require_positive("sigma_disparity", p.sigma_disparity);
  require(p.sigma_match >= 0.0, "sigma_match", "0 px or more", p.sigma_match);
  require(p.sigma_disparity_offset >= 0.0, "sigma_disparity_offset", "0 px or more",
          p.sigma_disparity_offset);
  require(p.disparity_offset_drift >= 0.0, "disparity_offset_drift", "0 px/sqrt(s) or more",
          p.disparity_offset_drift);
  require_positive("max_offset_sigma", p.max_offset_sigma);
  require(p.correlated_pairs >= 1.0, "correlated_pairs", "1 or more", p.correlated_pairs);
  require(p.min_tracks >= 6, "min_tracks", "at least 6", p.min_tracks);
  require(p.min_inliers >= 6, "min_inliers", "at least 6", p.min_inliers);
  require(p.min_inlier_ratio >= 0.0 && p.min_inlier_ratio <= 1.0, "min_inlier_ratio", "0 to 1",
          p.min_inlier_ratio);
  require_positive("ransac_threshold", p.ransac_threshold);
  require(p.ransac_confidence > 0.0 && p.ransac_confidence < 1.0, "ransac_confidence",
          "between 0 and 1", p.ransac_confidence);
  require_positive("ransac_max_hypotheses", p.ransac_max_hypotheses);
  require_positive("huber", p.huber);
  require_positive("outlier_sigmas", p.outlier_sigmas);
  require_positive("refine_max_iterations", p.refine_max_iterations);
  require(p.window_frames == 0 ||
              (p.window_frames >= 3 && p.window_frames <= static_cast<int>(kLargestWindow)),
          "window_frames", "0 or 3 to 12", p.window_frames);
  require_positive("window_max_points", p.window_max_points);
  require_positive("window_iterations", p.window_iterations);
  require(p.window_min_flow >= 0.0, "window_min_flow", "0 px or more", p.window_min_flow);
  require_positive("sigma_acceleration", p.sigma_acceleration);
  require_positive("sigma_turn_acceleration", p.sigma_turn_acceleration);
  require_positive("max_speed", p.max_speed);
  require_positive("max_acceleration", p.max_acceleration);
  require_positive("max_yaw_rate", p.max_yaw_rate);
  require_positive("max_turn_acceleration", p.max_turn_acceleration);
  require_positive("max_gap", p.max_gap);
  require_positive("max_stale_pairs", p.max_stale_pairs);
}

bool has_size(const GreyImage& image, const StereoCalibration& calibration) {
  return image.width == calibration.width && image.height == calibration.height &&
         image.pixels.size() ==
             static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

}  // namespace maploop::stereo
