// From stereo tracks to the camera's motion: consensus, adjustment, honest refusal.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// What the stereo pair itself says about its rectification: true disparity = measured + value.
struct DisparityOffset {
  double value = 0.0;  // px
  double sigma = 0.0;  // px; 0: known, not estimated
};

// The offset `seconds` later: a random walk of disparity_offset_drift.
DisparityOffset drifted(const DisparityOffset& offset, double seconds,
                        const StereoParameters& parameters);

struct CameraMotion {
  OdometryStatus status = OdometryStatus::too_few_features;  // ok, too_few_features, too_few_inliers
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  // Translation (m), then rotation vector (rad), of cam at the current epoch, in cam at the
  // previous one.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  DisparityOffset offset;  // after this pair's measurements; as it came in where status is not ok
  int tracked = 0;           // tracks with usable, finite measurements
  std::vector<int> inliers;  // indices of tracks, ascending
};

// Tracks may come from the images or from a file. Those with a disparity outside the limits, rows
// that differ by more than max_row_error, or numbers that are not finite, do not count. `seed`
// makes the sampling repeatable; `offset` is what is known of the disparities' offset so far;
// `expected` is the motion (T_previous_current) a constant velocity would give.
CameraMotion estimate_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                             std::span<const StereoTrack> tracks, std::uint64_t seed,
                             const DisparityOffset& offset,
                             const std::optional<Eigen::Isometry3d>& expected = std::nullopt);

// Carries a motion and its covariance from cam to body.
void to_body(const Eigen::Isometry3d& T_body_cam, const CameraMotion& motion,
             RelativeMotion* result);

}  // namespace maploop::stereo
