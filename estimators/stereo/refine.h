// The motion and the points' depths are adjusted over two epochs here.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// Expresses what a vehicle's inertia predicts for its next motion.
struct MotionPrior {
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam, expected
  // These are the standard deviations of the perturbation (residual.h): first m, then rad.
  Eigen::Matrix<double, 6, 1> sigma = Eigen::Matrix<double, 6, 1>::Ones();

  // Returns the perturbation from the expected motion to `pose`, in standard deviations.
  Eigen::Matrix<double, 6, 1> residual(const Eigen::Isometry3d& pose) const {
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(pose.linear() * T_previous_current.linear().transpose()));
    Eigen::Matrix<double, 6, 1> r;
    r << pose.translation() - T_previous_current.translation(), turn.angle() * turn.axis();
    return r.cwiseQuotient(sigma);
  }
};

struct Refinement {
  bool ok =
      false;  // false: no finite solution (fewer than three usable tracks, or degenerate geometry)
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  // This is the covariance of the perturbation of residual.h: translation (m), then rotation (rad),
  // in cam at the previous epoch; scaled by the residuals' own variance and by correlated_pairs.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // This pair alone gives this estimate of a constant offset of all disparities (true = measured +
  // offset), px. An offset makes near and far points disagree about the distance travelled.
  double offset = 0.0;
  double offset_sigma = 0.0;
  // This is the change of the motion per px of additional offset. The covariance contains it times
  // assumed_offset_sigma.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();
  double variance_factor = 0.0;  // of the residuals relative to sigma_track, sigma_disparity
  std::vector<int> inliers;      // indices of tracks within outlier_sigmas
  int iterations = 0;
};

// Adjusts the left position and the disparity of both epochs by Levenberg-Marquardt, starting from
// `T_previous_current` with the tracks in `inliers`. The tracker follows the previous left
// position, so this position has no error of its own. The unknown of a point is its disparity
// there, which is eliminated by the Schur complement. Each track's whitened residual has a Huber
// weight. After the first round all tracks are reassessed and a second round follows. The
// disparities' offset is not estimated but considered (Schmidt 1966): the motion uses the tracks as
// they are, and its covariance contains the effect of `assumed_offset_sigma` (px). `prior`
// determines the motion where the tracks do not (if they are few, or all on one side).
Refinement refine_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                         std::span<const StereoTrack> tracks, std::span<const int> inliers,
                         const Eigen::Isometry3d& T_previous_current, double assumed_offset_sigma,
                         const std::optional<MotionPrior>& prior = std::nullopt);

}  // namespace maploop::stereo
