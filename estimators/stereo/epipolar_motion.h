// The motion of one camera is estimated from its images alone (2D-to-2D; thesis 3.12).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/refine.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// Estimates rotation and direction of T_previous_current from the left positions: five-point
// algorithm in RANSAC (Nister, "An efficient solution to the five-point relative pose problem",
// PAMI 26, 2004), then Gauss-Newton on Sampson's distance with Huber weights. One camera cannot
// observe the length of the translation: it is set to `step` (m), and the covariance contains a
// standard deviation of the same size along the direction.
Refinement epipolar_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                           std::span<const StereoTrack> tracks, double step);

// Returns the signed Sampson distance of a track to the epipolar geometry of a motion, px (Hartley
// and Zisserman, "Multiple View Geometry", 2nd edition, eq. 11.9).
double sampson_distance(const StereoCalibration& camera,
                        const Eigen::Isometry3d& T_previous_current, const StereoTrack& track);

}  // namespace maploop::stereo
