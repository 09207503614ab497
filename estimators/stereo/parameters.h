// Everything that can be set in the stereo visual odometry.
#pragma once

#include "estimators/stereo/methods.h"

namespace maploop::stereo {

struct StereoParameters {
  // --- Methods (methods.h)
  Matching matching = Matching::klt;                    // or "sift"
  MotionMethod motion = MotionMethod::points_to_image;  // "3d-2d"; or "3d-3d", "2d-2d"
  double assumed_speed = 10.0;  // m/s, what "2d-2d" takes for the speed it cannot see
  int sift_features = 1000;     // per image, strongest first
  double sift_ratio = 0.8;      // of the distances to the nearest and second nearest (Lowe 2004)

  // --- Corner detection
  int bucket_size = 50;  // px; features spread over the image pin down rotation and translation
  int features_per_bucket = 3;  // 8 x 25 buckets of a 1242 x 375 image; about 210 can be followed
  int fast_threshold = 10;      // grey levels; low, for roads have little contrast
  // Squared grey levels per pixel: smaller eigenvalue of the mean gradient tensor.
  double min_corner_response = 50.0;
  int min_feature_distance = 12;  // px; closer windows would measure the same pixels twice

  // --- Lucas-Kanade tracking
  int window = 15;           // px, odd; side of the compared square
  int pyramid_levels = 4;    // above the full image; used where no motion is known yet
  int predicted_levels = 1;  // above the full image, when the last motion predicts the position
  int max_iterations = 15;   // per level
  double min_step = 0.02;    // px; an iteration that moves less is the last one

  // --- Stereo match and consistency
  double min_disparity = 1.0;     // px
  double max_disparity = 160.0;   // px; 2.4 m at KITTI's calibration
  double min_correlation = 0.85;  // of a new feature's patch along the right image's row
  double max_row_error = 1.0;     // px between rectified rows
  double max_closure = 1.0;       // px between the two ways round the circle

  // --- Measurement noise
  double sigma_track = 0.15;  // px per axis, position in the left image from one pair to the next
  double sigma_disparity = 0.2;  // px, what changes in a match from one pair to the next
  double sigma_match = 0.4;      // px, what a match keeps wrong while the feature lives
  // Least factor on the covariance (track_ages.h says when it is more), for features return with
  // the same match error in pair after pair and the errors of successive motions add up. Odometries
  // from disjoint halves of the features differ over a second by what 1.7 predicts; the rest is for
  // what both halves share.
  double correlated_pairs = 5.0;

  // --- Disparity offset (disparity_offset.h)
  // px before any data: what a rectification may leave; 0: it is taken as perfect.
  double sigma_disparity_offset = 0.3;
  double disparity_offset_drift = 0.003;  // px / sqrt(s): 0.2 px in an hour of warming up
  double max_offset_sigma = 0.15;  // px; a pair that sees it worse tells more of its outliers
  int min_offset_inliers = 100;    // with fewer, single match errors outweigh a common one

  // --- Motion estimate
  int min_tracks = 25;            // fewer: too_few_features
  int min_inliers = 25;           // fewer: too_few_inliers
  double min_inlier_ratio = 0.4;  // less: too_few_inliers
  double ransac_threshold = 2.0;  // px, in each image
  double ransac_confidence = 0.999;
  int ransac_max_hypotheses = 200;
  double huber = 2.0;              // whitened residual from which a track's weight falls
  double outlier_sigmas = 4.0;     // whitened residual beyond which a track is left out
  int refine_max_iterations = 10;  // of each of the two rounds

  // --- Windowed bundle adjustment (bundle_adjustment.h)
  int window_frames = 6;        // poses adjusted together, 3 to 12; 0: from pair to pair only
  int window_max_points = 300;  // more features than buckets keep alive
  int window_iterations = 5;
  double window_min_flow = 1.0;  // px, median; a pose that moved less gives way to the next one

  // --- Names of what is odd
  double standstill_flow = 0.3;  // px, median; less is called a standstill
  double dark_level = 15.0;      // grey levels, mean; a pair without features is called dark below

  // --- Inertia and plausibility of a road vehicle
  // One standard deviation of its acceleration, m/s^2 and rad/s^2: ordinary braking, and the
  // pitching of a car on its springs.
  double sigma_acceleration = 3.0;
  double sigma_turn_acceleration = 1.0;
  double max_speed = 70.0;        // m/s
  double max_acceleration = 8.0;  // m/s^2, from one motion to the next
  double max_yaw_rate = 1.5708;   // rad/s (90 deg/s)
  // rad/s^2, any axis, from one motion to the next; a bump at 30 km/h makes 3.
  double max_turn_acceleration = 4.0;
  double max_gap = 1.0;      // s; an older pair is not compared with any more
  int max_stale_pairs = 10;  // pairs in a row with old stamps after which time starts anew
};

}  // namespace maploop::stereo
