// From stereo tracks of successive pairs to the motions of the body.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/disparity_offset.h"
#include "estimators/stereo/motion_estimator.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// What follows the front end, whether the tracks come from images or from a file: resect, adjust,
// judge, and remember the velocity and the disparities' offset for the next pair.
//
// Not thread-safe; the same tracks give the same bits.
class BackEnd {
 public:
  BackEnd(const StereoCalibration& calibration, const StereoParameters& parameters);

  // T_previous_current over `seconds` if the body goes on as it went; nothing after a refusal.
  std::optional<Eigen::Isometry3d> expected_motion(double seconds) const;

  // Motion from result->from to result->stamp, which are set. Fills in status, tracked and inliers,
  // and where the status is ok pose and covariance of the body. Returns the indices of the tracks
  // that agree with an accepted motion, ascending; valid until the next call.
  const std::vector<int>& process(std::span<const StereoTrack> tracks, RelativeMotion* result);

  double disparity_offset() const { return offset_.value(); }

 private:
  void remember(const CameraMotion& motion, const RelativeMotion& result, double seconds);

  StereoCalibration camera_;
  StereoParameters parameters_;

  Eigen::Isometry3d last_motion_ = Eigen::Isometry3d::Identity();  // cam
  std::optional<Eigen::Vector3d> last_velocity_;  // m/s, body; none after a refusal
  double last_seconds_ = 0.0;
  DisparityOffset offset_;
  std::vector<int> agreeing_;
};

}  // namespace maploop::stereo
