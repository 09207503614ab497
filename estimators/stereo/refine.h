// Two-epoch adjustment of the motion and of the points' depths.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/motion_prior.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

struct Refinement {
  bool ok =
      false;  // false: no finite solution (fewer than three usable tracks, degenerate geometry)
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  // Of the perturbation of residual.h: translation m, then rotation rad, in cam at the previous
  // epoch; scaled by the residuals' own variance and by correlated_pairs.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // What this pair alone says of a constant offset of all disparities (true = measured + offset),
  // px. An offset makes near and far points disagree about the way driven.
  double offset = 0.0;
  double offset_sigma = 0.0;
  // What the motion changes by where the offset is a px larger; in the covariance, times
  // assumed_offset_sigma.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();
  double variance_factor = 0.0;  // of the residuals against sigma_track and sigma_disparity
  std::vector<int> inliers;      // indices of tracks within outlier_sigmas
  int iterations = 0;
};

// Levenberg-Marquardt on the left position and the disparity of both epochs, starting from
// `T_previous_current` with the tracks named in `inliers`. The previous left position is what the
// tracker follows, so it carries no error of its own; the unknown of a point is its disparity
// there, eliminated by the Schur complement. Huber weights on each track's whitened residual. After
// the first round every track is judged anew and a second round follows. The disparities' offset is
// not estimated but considered (Schmidt 1966): the motion takes the tracks as they are, and its
// covariance carries what `assumed_offset_sigma` (px) leaves open. `prior` decides where the tracks
// leave the motion open (few of them, or all on one side).
Refinement refine_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                         std::span<const StereoTrack> tracks, std::span<const int> inliers,
                         const Eigen::Isometry3d& T_previous_current, double assumed_offset_sigma,
                         const std::optional<MotionPrior>& prior = std::nullopt);

}  // namespace maploop::stereo
