// The back end computes the motions of the body from the stereo tracks of successive pairs.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "estimators/stereo/bundle_adjustment.h"
#include "estimators/stereo/disparity_offset.h"
#include "estimators/stereo/motion_estimator.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/plausibility.h"
#include "estimators/stereo/track_ages.h"
#include "estimators/stereo/tracks.h"
#include "estimators/stereo/window.h"
#include "msgs/calibration.h"
#include "msgs/visual_motion.h"

namespace maploop::stereo {

// Performs all steps after the front end, for tracks from images or from a file: it resects and
// adjusts the pair, judges the motion, adjusts the window, and keeps the velocity and the
// disparities' offset for the next pair.
//
// With a window, the motions compose to the path of the window's newest pose: each motion starts at
// the previously reported pose, so that later corrections of this pose by the window are not lost.
//
// Not thread-safe. The same tracks give the same bits.
class BackEnd {
 public:
  BackEnd(const StereoCalibration& calibration, const StereoParameters& parameters);

  // Returns T_previous_current over `seconds` if the body keeps its last velocity. Returns nothing
  // if this velocity is unknown or older than max_gap.
  std::optional<Eigen::Isometry3d> expected_motion(Time stamp, double seconds) const;

  // Computes the motion from result->from to result->stamp, which must be set. Fills in status,
  // tracked and inliers; if the status is ok, also pose and covariance of the body, condition and
  // parallax. Returns the indices of the tracks that agree with an accepted motion, ascending; they
  // are valid until the next call.
  const std::vector<int>& process(std::span<const StereoTrack> tracks, RelativeMotion* result);

  // Fills in how the last accepted motion depends on the disparities' offset.
  void describe_offset(VisualMotion* motion) const;

  void on_stage(StageListener listener) { stage_ = std::move(listener); }

  double disparity_offset() const { return offset_.value(); }

  // The other members are parameters and buffers of one call.
  template <class Archive>
  void archive(Archive& ar) {
    ar(moved_, last_stamp_, last_seconds_, last_motion_, last_velocity_, offset_, ages_, window_);
  }

 private:
  std::optional<MotionPrior> prior(Time stamp, double seconds) const;
  bool known(Time stamp) const;  // whether the last velocity is recent enough
  CameraMotion estimate(std::span<const StereoTrack> tracks, const RelativeMotion& result) const;
  bool other_motion(std::span<const StereoTrack> tracks, const CameraMotion& motion,
                    const RelativeMotion& result) const;
  bool accept(const CameraMotion& motion, double seconds, RelativeMotion* result) const;
  void remember(const Eigen::Isometry3d& motion, double seconds, const RelativeMotion& result);
  void widen(std::span<const StereoTrack> tracks, const CameraMotion& motion,
             RelativeMotion* result);
  void adjust_window(std::span<const StereoTrack> tracks, CameraMotion* motion,
                     RelativeMotion* result);

  StereoCalibration camera_;
  StereoParameters parameters_;

  bool moved_ = false;  // true once the members below hold an accepted motion
  Time last_stamp_{};
  double last_seconds_ = 0.0;
  Eigen::Isometry3d last_motion_ = Eigen::Isometry3d::Identity();  // cam
  LastVelocity last_velocity_;

  DisparityOffset offset_;
  TrackAges ages_;
  Window window_;
  BundleAdjustment adjustment_;
  std::vector<int> agreeing_;
  Eigen::Matrix<double, 6, 1> by_offset_ = Eigen::Matrix<double, 6, 1>::Zero();  // body, 1 / px
  double offset_sigma_ = 0.0;  // px, as contained in the last covariance
  StageListener stage_;
};

}  // namespace maploop::stereo
