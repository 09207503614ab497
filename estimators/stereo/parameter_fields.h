// Every parameter by name: what a configuration file sets, and what an archive must agree with.
#pragma once

#include <concepts>
#include <type_traits>

#include "estimators/stereo/parameters.h"

namespace maploop::stereo {

// Calls f(name, member) for each; Parameters is StereoParameters, const or not.
template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, StereoParameters>
void fields(Parameters& p, F&& f) {
  f("matching", p.matching);
  f("motion", p.motion);
  f("assumed_speed", p.assumed_speed);
  f("sift_features", p.sift_features);
  f("sift_ratio", p.sift_ratio);
  f("bucket_size", p.bucket_size);
  f("features_per_bucket", p.features_per_bucket);
  f("fast_threshold", p.fast_threshold);
  f("min_corner_response", p.min_corner_response);
  f("min_feature_distance", p.min_feature_distance);
  f("window", p.window);
  f("pyramid_levels", p.pyramid_levels);
  f("predicted_levels", p.predicted_levels);
  f("max_iterations", p.max_iterations);
  f("min_step", p.min_step);
  f("min_disparity", p.min_disparity);
  f("max_disparity", p.max_disparity);
  f("min_correlation", p.min_correlation);
  f("max_row_error", p.max_row_error);
  f("max_closure", p.max_closure);
  f("sigma_track", p.sigma_track);
  f("sigma_disparity", p.sigma_disparity);
  f("sigma_match", p.sigma_match);
  f("correlated_pairs", p.correlated_pairs);
  f("sigma_disparity_offset", p.sigma_disparity_offset);
  f("disparity_offset_drift", p.disparity_offset_drift);
  f("max_offset_sigma", p.max_offset_sigma);
  f("min_offset_inliers", p.min_offset_inliers);
  f("min_tracks", p.min_tracks);
  f("min_inliers", p.min_inliers);
  f("min_inlier_ratio", p.min_inlier_ratio);
  f("ransac_threshold", p.ransac_threshold);
  f("ransac_confidence", p.ransac_confidence);
  f("ransac_max_hypotheses", p.ransac_max_hypotheses);
  f("huber", p.huber);
  f("outlier_sigmas", p.outlier_sigmas);
  f("refine_max_iterations", p.refine_max_iterations);
  f("window_frames", p.window_frames);
  f("window_max_points", p.window_max_points);
  f("window_iterations", p.window_iterations);
  f("window_min_flow", p.window_min_flow);
  f("standstill_flow", p.standstill_flow);
  f("dark_level", p.dark_level);
  f("sigma_acceleration", p.sigma_acceleration);
  f("sigma_turn_acceleration", p.sigma_turn_acceleration);
  f("max_speed", p.max_speed);
  f("max_acceleration", p.max_acceleration);
  f("max_yaw_rate", p.max_yaw_rate);
  f("max_turn_acceleration", p.max_turn_acceleration);
  f("max_gap", p.max_gap);
  f("max_stale_pairs", p.max_stale_pairs);
}

}  // namespace maploop::stereo
