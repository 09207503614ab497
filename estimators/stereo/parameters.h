// Everything that can be set in the stereo visual odometry; parameter_table.cpp says what each
// means.
#pragma once

#include "estimators/stereo/methods.h"

namespace maploop::stereo {

struct StereoParameters {
  // --- Methods (methods.h)
  Matching matching = Matching::klt;
  MotionMethod motion = MotionMethod::points_to_image;
  double assumed_speed = 10.0;  // m/s
  int sift_features = 1000;
  double sift_ratio = 0.8;

  // --- Corner detection
  int bucket_size = 50;  // px
  int features_per_bucket = 3;
  int fast_threshold = 10;
  double min_corner_response = 50.0;  // grey levels^2/px
  int min_feature_distance = 12;      // px

  // --- Lucas-Kanade tracking
  int window = 15;  // px
  int pyramid_levels = 4;
  int predicted_levels = 1;
  int max_iterations = 15;
  double min_step = 0.02;  // px

  // --- Stereo match and consistency
  double min_disparity = 1.0;    // px
  double max_disparity = 160.0;  // px
  double min_correlation = 0.85;
  double max_row_error = 1.0;  // px
  double max_closure = 1.0;    // px

  // --- Measurement noise
  double sigma_track = 0.15;     // px
  double sigma_disparity = 0.2;  // px
  double sigma_match = 0.4;      // px
  double correlated_pairs = 5.0;

  // --- Disparity offset (disparity_offset.h)
  double sigma_disparity_offset = 0.3;    // px
  double disparity_offset_drift = 0.003;  // px/sqrt(s)
  double max_offset_sigma = 0.15;         // px
  int min_offset_inliers = 100;

  // --- Motion estimate
  int min_tracks = 25;
  int min_inliers = 25;
  double min_inlier_ratio = 0.4;
  double ransac_threshold = 2.0;  // px
  double ransac_confidence = 0.999;
  int ransac_max_hypotheses = 200;
  double huber = 2.0;
  double outlier_sigmas = 4.0;
  int refine_max_iterations = 10;

  // --- Windowed bundle adjustment (bundle_adjustment.h)
  int window_frames = 6;
  int window_max_points = 300;
  int window_iterations = 5;
  double window_min_flow = 1.0;  // px

  // --- Diagnosis
  double standstill_flow = 0.3;  // px
  double dark_level = 15.0;      // grey levels

  // --- Inertia and plausibility of a road vehicle
  double sigma_acceleration = 3.0;       // m/s^2
  double sigma_turn_acceleration = 1.0;  // rad/s^2
  double max_speed = 70.0;               // m/s
  double max_acceleration = 8.0;         // m/s^2
  double max_yaw_rate = 1.5708;          // rad/s (90 deg/s)
  double max_turn_acceleration = 4.0;    // rad/s^2
  double max_gap = 1.0;                  // s
  int max_stale_pairs = 10;
};

}  // namespace maploop::stereo
