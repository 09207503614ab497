// This header finds the motion on which most tracks agree.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

struct Consensus {
  Eigen::Isometry3d T_current_previous = Eigen::Isometry3d::Identity();  // cam
  std::vector<int> inliers;                                              // indices of tracks
  int hypotheses = 0;                                                    // tried
};

// Forms hypotheses by P3P on three tracks (points triangulated at the previous epoch, seen from the
// current left camera), or, if parameters.motion is "3d-3d", by aligning three points to three.
// They are scored on both current images with a truncated square (MSAC; Torr and Zisserman, CVIU
// 78, 2000). The number of hypotheses follows the best inlier ratio w so far, N = ln(1 - P) / ln(1
// - w^3), up to the maximum. `expected`, if given, is the first hypothesis. Tracks need positive
// disparities. The inliers are empty if no hypothesis can be formed.
Consensus ransac_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                        std::span<const StereoTrack> tracks, std::uint64_t seed,
                        const std::optional<Eigen::Isometry3d>& expected);

}  // namespace maploop::stereo
