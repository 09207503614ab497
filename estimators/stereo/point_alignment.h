// Motion from points triangulated at both epochs (3D-to-3D; thesis 3.11).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "estimators/stereo/motion_prior.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/refine.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// T_previous_current that brings the current points onto the previous ones with the least weighted
// sum of squares: closed form (Umeyama, "Least-squares estimation of transformation parameters
// between two point patterns", PAMI 13, 1991; no scale). A point's weight is the inverse of its
// depths' variances. Nothing where the points are fewer than three or on a line.
std::optional<Eigen::Isometry3d> align_points(const StereoCalibration& camera,
                                              const StereoParameters& parameters,
                                              std::span<const StereoTrack> tracks,
                                              std::span<const int> chosen);

// From the closed form by Gauss-Newton to the least distances in the points' own covariances, which
// reach far along the line of sight and hardly across it; Huber weights and a second round with
// the tracks judged anew, as in refine_motion. Of the disparities' offset it says nothing.
Refinement refine_alignment(const StereoCalibration& camera, const StereoParameters& parameters,
                            std::span<const StereoTrack> tracks, std::span<const int> inliers,
                            const std::optional<MotionPrior>& prior = std::nullopt);

}  // namespace maploop::stereo
