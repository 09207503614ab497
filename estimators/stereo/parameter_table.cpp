#include "estimators/stereo/parameter_table.h"

#include "estimators/stereo/window.h"

namespace maploop::stereo {

ParameterTable<StereoParameters> parameter_table(const StereoParameters&) {
  using enum Audience;
  using P = StereoParameters;
  constexpr double large = 1e6;
  constexpr int many = 1'000'000;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"matching", one_of<&P::matching>, usual,
       "How features are matched: \"klt\" tracks corners (Lucas-Kanade), \"sift\" compares "
       "descriptors."},
      {"motion", one_of<&P::motion>, usual,
       "How the motion is estimated: \"3d-2d\" from points to their images, \"3d-3d\" from points "
       "to points, \"2d-2d\" from the left camera alone, which leaves the scale unknown."},
      {"assumed_speed", &P::assumed_speed, above_zero, large, "m/s", expert,
       "Speed that \"2d-2d\" assumes, since it cannot measure it."},
      {"sift_features", &P::sift_features, 1, many, "features", expert,
       "Features of an image at most; the strongest are kept."},
      {"sift_ratio", &P::sift_ratio, above_zero, 1.0, "1", expert,
       "Largest accepted ratio of the distances to the nearest and to the second nearest "
       "descriptor (Lowe 2004)."},
      {"bucket_size", &P::bucket_size, 8, many, "px", usual,
       "Edge of the squares over which features are spread, because well spread features determine "
       "rotation and translation well."},
      {"features_per_bucket", &P::features_per_bucket, 1, many, "features", expert,
       "Features kept in each square. An image of 1242 x 375 px has 8 x 25 squares; about 210 "
       "features can be tracked."},
      {"fast_threshold", &P::fast_threshold, 1, 254, "grey levels", expert,
       "Contrast of a corner. The default is low because roads have little contrast."},
      {"min_corner_response", &P::min_corner_response, 0.0, 1e9, "grey levels^2/px", expert,
       "Least smaller eigenvalue of the mean gradient tensor at a corner."},
      {"min_feature_distance", &P::min_feature_distance, 0, many, "px", expert,
       "Least distance between two features. The windows of closer features would measure the same "
       "pixels twice."},
      {"window", &P::window, 5, 51, "px", expert,
       "Edge of the square that Lucas-Kanade compares. It must be odd."},
      {"pyramid_levels", &P::pyramid_levels, 1, 6, "levels", expert,
       "Levels of the image pyramid above the full image, used where no motion is known yet."},
      {"predicted_levels", &P::predicted_levels, 0, 6, "levels", expert,
       "Levels of the image pyramid used where the previous motion predicts the position of a "
       "feature."},
      {"max_iterations", &P::max_iterations, 1, many, "iterations", expert,
       "Lucas-Kanade iterations at most on each level."},
      {"min_step", &P::min_step, above_zero, large, "px", expert,
       "A Lucas-Kanade iteration with a smaller step is the last one."},
      {"min_disparity", &P::min_disparity, above_zero, large, "px", expert,
       "Least disparity of a stereo match."},
      {"max_disparity", &P::max_disparity, above_zero, large, "px", usual,
       "Largest disparity of a stereo match. The default is 2.4 m with KITTI's calibration."},
      {"min_correlation", &P::min_correlation, -1.0, 1.0, "1", expert,
       "Least correlation of a new feature's patch with the patch in the right image."},
      {"max_row_error", &P::max_row_error, above_zero, large, "px", expert,
       "Largest distance between the rows of a match in the rectified images."},
      {"max_closure", &P::max_closure, above_zero, large, "px", expert,
       "Largest distance between the positions found by the two ways around the circle of four "
       "images."},
      {"sigma_track", &P::sigma_track, above_zero, large, "px", expert,
       "Standard deviation per axis of a feature's position in the left image from one pair to the "
       "next."},
      {"sigma_disparity", &P::sigma_disparity, above_zero, large, "px", expert,
       "Standard deviation of the part of a match error that changes from pair to pair."},
      {"sigma_match", &P::sigma_match, 0.0, large, "px", expert,
       "Standard deviation of the part of a match error that stays as long as the feature lives."},
      {"correlated_pairs", &P::correlated_pairs, 1.0, large, "1", expert,
       "Least factor on the covariance; the factor is larger where features live longer. Features "
       "return with the same match error in pair after pair, so that the errors of successive "
       "motions add up. Odometries from disjoint halves of the features differ over a second by "
       "what 1.7 predicts; the rest is an allowance for errors common to both halves."},
      {"sigma_disparity_offset", &P::sigma_disparity_offset, 0.0, large, "px", expert,
       "Standard deviation of the offset that the rectification may leave in all disparities. 0: "
       "the rectification is taken as perfect."},
      {"disparity_offset_drift", &P::disparity_offset_drift, 0.0, large, "px/sqrt(s)", expert,
       "Random walk of that offset. The default is 0.2 px in an hour of warming up."},
      {"max_offset_sigma", &P::max_offset_sigma, above_zero, large, "px", expert,
       "A pair that determines the offset less well says more about its outliers, and is not used "
       "for it."},
      {"min_offset_inliers", &P::min_offset_inliers, 0, many, "features", expert,
       "Inliers from which a pair is used for the offset. With fewer, single match errors outweigh "
       "the common one."},
      {"min_tracks", &P::min_tracks, 6, many, "features", expert,
       "Fewer tracked features make the motion too_few_features."},
      {"min_inliers", &P::min_inliers, 6, many, "features", expert,
       "Fewer inliers make the motion too_few_inliers."},
      {"min_inlier_ratio", &P::min_inlier_ratio, 0.0, 1.0, "1", expert,
       "A smaller share of inliers makes the motion too_few_inliers."},
      {"ransac_threshold", &P::ransac_threshold, above_zero, large, "px", expert,
       "Reprojection error of an inlier at most, in each image."},
      {"ransac_confidence", &P::ransac_confidence, above_zero, 1.0 - 1e-9, "1", expert,
       "Probability with which RANSAC shall have drawn one sample without outliers."},
      {"ransac_max_hypotheses", &P::ransac_max_hypotheses, 1, many, "hypotheses", expert,
       "RANSAC hypotheses at most."},
      {"huber", &P::huber, above_zero, large, "1", expert,
       "Whitened residual from which the weight of a track falls."},
      {"outlier_sigmas", &P::outlier_sigmas, above_zero, large, "1", expert,
       "Whitened residual beyond which a track is left out."},
      {"refine_max_iterations", &P::refine_max_iterations, 1, many, "iterations", expert,
       "Iterations at most in each of the two rounds of the refinement."},
      {"window_frames", &P::window_frames, 0, static_cast<int>(largest_window), "frames", expert,
       "Poses adjusted together by the windowed bundle adjustment: 3 or more. 0: motions are "
       "estimated from pair to pair only."},
      {"window_max_points", &P::window_max_points, 1, many, "points", expert,
       "Points of the bundle adjustment at most. The default is more than the buckets keep alive."},
      {"window_iterations", &P::window_iterations, 1, many, "iterations", expert,
       "Iterations of the bundle adjustment at most."},
      {"window_min_flow", &P::window_min_flow, 0.0, large, "px", expert,
       "Median flow below which a pose gives way to the next one in the window."},
      {"standstill_flow", &P::standstill_flow, 0.0, large, "px", expert,
       "Median flow below which the vehicle is reported to stand still."},
      {"dark_level", &P::dark_level, 0.0, 255.0, "grey levels", expert,
       "Mean grey level below which a pair without features is reported as dark."},
      {"sigma_acceleration", &P::sigma_acceleration, above_zero, large, "m/s^2", expert,
       "Standard deviation of the vehicle's acceleration: ordinary braking."},
      {"sigma_turn_acceleration", &P::sigma_turn_acceleration, above_zero, large, "rad/s^2", expert,
       "Standard deviation of the vehicle's angular acceleration: a car pitching on its springs."},
      {"max_speed", &P::max_speed, above_zero, large, "m/s", usual,
       "A faster motion is refused as impossible for a road vehicle."},
      {"max_acceleration", &P::max_acceleration, above_zero, large, "m/s^2", expert,
       "A larger change of speed from one motion to the next is refused."},
      {"max_yaw_rate", &P::max_yaw_rate, above_zero, large, "rad/s", usual,
       "A faster turn is refused as impossible for a road vehicle."},
      {"max_turn_acceleration", &P::max_turn_acceleration, above_zero, large, "rad/s^2", expert,
       "A larger change of the angular rate about any axis from one motion to the next is refused. "
       "A bump at 30 km/h causes 3 rad/s^2."},
      {"max_gap", &P::max_gap, above_zero, large, "s", expert,
       "An older pair is not compared with the current one."},
      {"max_stale_pairs", &P::max_stale_pairs, 1, many, "pairs", expert,
       "Pairs in a row with old stamps after which the time is taken to have started again."},
  });
  const auto rules = [](const P& p) -> std::optional<ParameterProblem> {
    if (p.window % 2 == 0) return {{"window", "must be odd"}};
    if (p.predicted_levels > p.pyramid_levels)
      return {{"predicted_levels", "must be at most pyramid_levels"}};
    if (p.max_disparity <= p.min_disparity)
      return {{"max_disparity", "must be above min_disparity"}};
    if (p.window_frames != 0 && p.window_frames < 3)
      return {{"window_frames", "must be 0 or 3 to 12"}};
    if (p.motion == MotionMethod::image_to_image && p.window_frames != 0)
      return {{"window_frames", "must be 0 with motion = \"2d-2d\", which has no scale"}};
    return std::nullopt;
  };
  return {"stereo", "Stereo visual odometry.", table, rules};
}

}  // namespace maploop::stereo
