// Everything that can be set in the stereo visual odometry; parameter_table.cpp says what each
// means.
#pragma once

#include "estimators/stereo/methods.h"

namespace maploop::stereo {

// Holds the parameters of StereoOdometry, whose constructor checks them.
struct StereoParameters {
  // --- Methods (methods.h)
  Matching matching = Matching::klt;                    // how features are found again
  MotionMethod motion = MotionMethod::points_to_image;  // how a motion is estimated
  double assumed_speed = 10.0;                          // m/s
  int sift_features = 1000;  // of an image at most; the strongest are kept
  double sift_ratio = 0.8;   // most, of nearest to second nearest descriptor distance

  // --- Corner detection
  int bucket_size = 50;               // px, edge of the squares over which features are spread
  int features_per_bucket = 3;        // kept in each square
  int fast_threshold = 10;            // grey levels, contrast of a corner
  double min_corner_response = 50.0;  // grey levels^2/px
  int min_feature_distance = 12;      // px

  // --- Lucas-Kanade tracking
  int window = 15;           // px, odd; edge of the square that is compared
  int pyramid_levels = 4;    // above the full image, where no motion is known yet
  int predicted_levels = 1;  // the same where the previous motion predicts the position
  int max_iterations = 15;   // at most on each level
  double min_step = 0.02;    // px

  // --- Stereo match and consistency
  double min_disparity = 1.0;     // px, of a stereo match
  double max_disparity = 160.0;   // px
  double min_correlation = 0.85;  // of a new feature's patches in both images, -1 to 1
  double max_row_error = 1.0;     // px
  double max_closure = 1.0;       // px

  // --- Measurement noise
  double sigma_track = 0.15;      // px per axis, in the left image from pair to pair
  double sigma_disparity = 0.2;   // px
  double sigma_match = 0.4;       // px
  double correlated_pairs = 5.0;  // least factor on the covariance, for shared match errors

  // --- Disparity offset (disparity_offset.h)
  double sigma_disparity_offset = 0.3;    // px, that the rectification may leave; 0: none
  double disparity_offset_drift = 0.003;  // px/sqrt(s)
  double max_offset_sigma = 0.15;         // px
  int min_offset_inliers = 100;           // fewer do not determine the offset

  // --- Motion estimate
  int min_tracks = 25;               // fewer make the motion too_few_features
  int min_inliers = 25;              // fewer make the motion too_few_inliers
  double min_inlier_ratio = 0.4;     // of the tracks; a smaller one makes it too_few_inliers
  double ransac_threshold = 2.0;     // px
  double ransac_confidence = 0.999;  // probability of a sample without outliers
  int ransac_max_hypotheses = 200;   // at most
  double huber = 2.0;                // whitened residual from which a track's weight falls
  double outlier_sigmas = 4.0;       // whitened residual beyond which a track is left out
  int refine_max_iterations = 10;    // at most in each of the two rounds

  // --- Windowed bundle adjustment (bundle_adjustment.h)
  int window_frames = 6;         // poses adjusted together, 3 or more; 0: none are
  int window_max_points = 300;   // adjusted at most
  int window_iterations = 5;     // at most for each pair
  double window_min_flow = 1.0;  // px

  // --- Diagnosis
  double standstill_flow = 0.3;  // px, median; less is a standstill
  double dark_level = 15.0;      // grey levels

  // --- Inertia and plausibility of a road vehicle
  double sigma_acceleration = 3.0;       // m/s^2, of the vehicle's acceleration
  double sigma_turn_acceleration = 1.0;  // rad/s^2
  double max_speed = 70.0;               // m/s
  double max_acceleration = 8.0;         // m/s^2
  double max_yaw_rate = 1.5708;          // rad/s (90 deg/s)
  double max_turn_acceleration = 4.0;    // rad/s^2
  double max_gap = 1.0;                  // s
  int max_stale_pairs = 10;              // with old stamps in a row; then time starts again
};

}  // namespace maploop::stereo
