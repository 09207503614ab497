// The motion is estimated here from points triangulated at both epochs (3D-to-3D; thesis 3.11).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/refine.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// Returns T_previous_current that maps the current points onto the previous ones with the least
// weighted sum of squares, in closed form (Umeyama, "Least-squares estimation of transformation
// parameters between two point patterns", PAMI 13, 1991; no scale). A point's weight is the inverse
// of the sum of its two depth variances. Returns nothing for fewer than three points or points on a
// line.
std::optional<Eigen::Isometry3d> align_points(const StereoCalibration& camera,
                                              const StereoParameters& parameters,
                                              std::span<const StereoTrack> tracks,
                                              std::span<const int> chosen);

// Refines the closed form by Gauss-Newton to the least distances in the points' own covariances,
// which are large along the line of sight and small across it. Huber weights and a second round
// with reassessed tracks work as in refine_motion. It does not estimate the disparities' offset.
Refinement refine_alignment(const StereoCalibration& camera, const StereoParameters& parameters,
                            std::span<const StereoTrack> tracks, std::span<const int> inliers,
                            const std::optional<MotionPrior>& prior = std::nullopt);

}  // namespace maploop::stereo
