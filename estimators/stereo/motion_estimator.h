// From stereo tracks to the camera's motion: consensus, adjustment, honest refusal.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/disparity_offset.h"
#include "estimators/stereo/motion_prior.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/stage_listener.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

struct CameraMotion {
  OdometryStatus status =
      OdometryStatus::too_few_features;  // ok, too_few_features, too_few_inliers
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  // Translation (m), then rotation vector (rad), of cam at the current epoch, in cam at the
  // previous one.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // What the motion changes by where the disparities' offset is a px larger.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();
  double offset = 0.0;        // px still missing in the disparities, as this pair sees it,
  double offset_sigma = 0.0;  // and its standard deviation
  int tracked = 0;            // tracks with usable, finite measurements
  std::vector<int> inliers;   // indices of tracks, ascending
};

// Tracks may come from the images or from a file. Those with a disparity outside the limits, rows
// that differ by more than max_row_error, or numbers that are not finite, do not count. `seed`
// makes the sampling repeatable; `offset` is added to every disparity; `prior` is what the motion
// before lets expect. parameters.motion says how: with "2d-2d" the translation has the length 1.
CameraMotion estimate_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                             std::span<const StereoTrack> tracks, std::uint64_t seed,
                             const DisparityOffset& offset,
                             const std::optional<MotionPrior>& prior = std::nullopt,
                             const StageListener& stage = {});

// Gives a motion of length 1 (m) another length, which is known to no better than itself; 0 is a
// camera that stands.
void lengthen(CameraMotion* motion, double length);

// Carries a motion and its covariance from cam to body.
void to_body(const Eigen::Isometry3d& T_body_cam, const CameraMotion& motion,
             RelativeMotion* result);
// by_offset in the body, as its covariance.
Eigen::Matrix<double, 6, 1> offset_effect_on_body(const Eigen::Isometry3d& T_body_cam,
                                                  const CameraMotion& motion);

}  // namespace maploop::stereo
