// The camera's motion is estimated here from stereo tracks: consensus, adjustment, and refusal of
// unreliable results.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/disparity_offset.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/refine.h"
#include "estimators/stereo/stage_listener.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

struct CameraMotion {
  OdometryStatus status =
      OdometryStatus::too_few_features;  // ok, too_few_features or too_few_inliers
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  // This is the covariance of translation (m), then rotation vector (rad), of cam at the current
  // epoch, in cam at the previous one.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  // This is the change of the motion per px of additional disparity offset.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();
  double offset = 0.0;        // px, remaining disparity offset estimated from this pair
  double offset_sigma = 0.0;  // px, its standard deviation
  int tracked = 0;            // tracks with usable, finite measurements
  std::vector<int> inliers;   // indices of tracks, ascending
};

// Estimates the motion from tracks of images or of a file. It ignores tracks with a disparity
// outside the limits, with rows that differ by more than max_row_error, or with numbers that are
// not finite. `seed` makes the sampling repeatable, `offset` is added to every disparity, and
// `prior` is the motion expected from the previous one. parameters.motion selects the method; with
// "2d-2d" the translation has length 1.
CameraMotion estimate_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                             std::span<const StereoTrack> tracks, std::uint64_t seed,
                             const DisparityOffset& offset,
                             const std::optional<MotionPrior>& prior = std::nullopt,
                             const StageListener& stage = {});

// Scales a motion of length 1 to another length (m), whose standard deviation is the length itself.
// A length of 0 describes a standing camera.
void lengthen(CameraMotion* motion, double length);

// Transforms a motion and its covariance from cam to body.
void to_body(const Eigen::Isometry3d& T_body_cam, const CameraMotion& motion,
             RelativeMotion* result);
// Returns by_offset transformed to the body, in the order of the body's covariance, per px.
Eigen::Matrix<double, 6, 1> offset_effect_on_body(const Eigen::Isometry3d& T_body_cam,
                                                  const CameraMotion& motion);

}  // namespace maploop::stereo
