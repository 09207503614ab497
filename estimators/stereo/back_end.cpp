#include "estimators/stereo/back_end.h"

#include <algorithm>
#include <cmath>

#include "estimators/stereo/image_motion.h"

namespace maploop::stereo {

BackEnd::BackEnd(const StereoCalibration& calibration, const StereoParameters& parameters)
    : camera_(calibration),
      parameters_(parameters),
      offset_(parameters),
      window_(parameters),
      adjustment_(calibration, parameters) {}

bool BackEnd::known(Time stamp) const {
  return moved_ && stamp > last_stamp_ && to_seconds(stamp - last_stamp_) <= parameters_.max_gap;
}

// This assumes constant velocity: the last motion is scaled in time.
std::optional<Eigen::Isometry3d> BackEnd::expected_motion(Time stamp, double seconds) const {
  if (!known(stamp)) return std::nullopt;
  const double ratio = seconds / last_seconds_;
  const Eigen::AngleAxisd turn(last_motion_.linear());
  Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
  expected.linear() = Eigen::AngleAxisd(turn.angle() * ratio, turn.axis()).toRotationMatrix();
  expected.translation() = last_motion_.translation() * ratio;
  return expected;
}

std::optional<MotionPrior> BackEnd::prior(Time stamp, double seconds) const {
  const auto expected = expected_motion(stamp, seconds);
  if (!expected) return std::nullopt;
  // This is the time from the middle of the last motion to the middle of this one.
  const double since = to_seconds(stamp - last_stamp_) + 0.5 * (last_seconds_ - seconds);
  MotionPrior prior{*expected, {}};
  prior.sigma << Eigen::Vector3d::Constant(parameters_.sigma_acceleration * since * seconds),
      Eigen::Vector3d::Constant(parameters_.sigma_turn_acceleration * since * seconds);
  return prior;
}

// Fills in the motion of the body if a road vehicle can make it.
bool BackEnd::accept(const CameraMotion& motion, double seconds, RelativeMotion* result) const {
  RelativeMotion in_body;
  to_body(camera_.T_body_cam, motion, &in_body);
  std::optional<LastVelocity> last;
  if (known(result->stamp)) {
    last = last_velocity_;
    last->age = to_seconds(result->stamp - last_stamp_);
  }
  if (!plausible(in_body, seconds, last, parameters_)) return false;
  result->translation = in_body.translation;
  result->rotation = in_body.rotation;
  result->covariance = in_body.covariance;
  return true;
}

void BackEnd::remember(const Eigen::Isometry3d& motion, double seconds,
                       const RelativeMotion& result) {
  last_motion_ = motion;
  last_stamp_ = result.stamp;
  last_seconds_ = seconds;
  CameraMotion of_camera;
  of_camera.T_previous_current = motion;
  RelativeMotion in_body;
  to_body(camera_.T_body_cam, of_camera, &in_body);
  last_velocity_ = {in_body.translation / seconds, angular_velocity(in_body, seconds), 0.0};
  moved_ = true;
}

// If features live longer than correlated_pairs, motions also share their errors for longer.
void BackEnd::widen(std::span<const StereoTrack> tracks, const CameraMotion& motion,
                    RelativeMotion* result) {
  const double pairs = ages_.correlated_pairs(tracks, motion.inliers);
  const double factor = std::max(1.0, pairs / parameters_.correlated_pairs);  // (8) of METHOD.md
  result->covariance *= factor;
  by_offset_ = offset_effect_on_body(camera_.T_body_cam, motion);
  offset_sigma_ = std::sqrt(factor) * offset_.sigma();
}

void BackEnd::describe_offset(VisualMotion* motion) const {
  motion->offset = offset_.value();
  motion->offset_sigma = offset_sigma_;
  motion->by_offset = by_offset_;
}

void BackEnd::adjust_window(std::span<const StereoTrack> tracks, CameraMotion* motion,
                            RelativeMotion* result) {
  if (window_.empty() || window_.newest().stamp != result->from) {
    window_.clear();
    window_.poses.push_back({result->from, Eigen::Isometry3d::Identity()});
  }
  const Eigen::Isometry3d before = window_.newest().T_world_cam;
  window_.add(camera_, result->stamp, before * motion->T_previous_current, tracks, motion->inliers,
              offset_.value());
  if (!adjustment_.adjust(&window_)) {
    window_.clear();
    return;
  }
  const WindowPose& now = window_.newest();
  const WindowPose& last = window_.poses[window_.poses.size() - 2];
  remember(last.T_world_cam.inverse() * now.T_world_cam, to_seconds(now.stamp - last.stamp),
           *result);
  motion->T_previous_current = before.inverse() * now.T_world_cam;
  if (const auto covariance = adjustment_.newest_covariance(window_)) {
    const Eigen::Matrix<double, 6, 1> open = offset_.sigma() * motion->by_offset;
    motion->covariance = *covariance + open * open.transpose();
  }
  to_body(camera_.T_body_cam, *motion, result);
}

// Returns whether the tracks that do not agree with an implausible motion agree on a plausible one.
// The other tracks are then on a moving object.
bool BackEnd::other_motion(std::span<const StereoTrack> tracks, const CameraMotion& motion,
                           const RelativeMotion& result) const {
  std::vector<StereoTrack> others;
  auto next = motion.inliers.begin();
  for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
    if (next != motion.inliers.end() && *next == i) {
      ++next;
    } else {
      others.push_back(tracks[static_cast<std::size_t>(i)]);
    }
  }
  const double seconds = to_seconds(result.stamp - result.from);
  RelativeMotion second = result;
  const CameraMotion other = estimate(others, second);
  return other.status == OdometryStatus::ok && accept(other, seconds, &second);
}

// Estimates the camera's motion from result.from to result.stamp.
CameraMotion BackEnd::estimate(std::span<const StereoTrack> tracks,
                               const RelativeMotion& result) const {
  const double seconds = to_seconds(result.stamp - result.from);
  CameraMotion motion = estimate_motion(camera_, parameters_, tracks,
                                        static_cast<std::uint64_t>(to_nanoseconds(result.stamp)),
                                        offset_, prior(result.stamp, seconds), stage_);
  if (parameters_.motion == MotionMethod::image_to_image)
    lengthen(&motion, parameters_.assumed_speed * seconds);
  return motion;
}

const std::vector<int>& BackEnd::process(std::span<const StereoTrack> tracks,
                                         RelativeMotion* result) {
  const double seconds = to_seconds(result->stamp - result->from);
  offset_.predict(seconds);
  CameraMotion motion = estimate(tracks, *result);
  result->tracked = motion.tracked;
  result->inliers = static_cast<int>(motion.inliers.size());
  result->status = motion.status;
  agreeing_.clear();
  if (result->status != OdometryStatus::ok) return agreeing_;
  const ImageMotion seen = image_motion(camera_, tracks, motion.inliers, motion.T_previous_current);
  const bool stands = seen.flow < parameters_.standstill_flow;
  if (stands && parameters_.motion == MotionMethod::image_to_image) lengthen(&motion, 0.0);
  if (!accept(motion, seconds, result)) {
    result->status = other_motion(tracks, motion, *result) ? OdometryStatus::moving_objects
                                                           : OdometryStatus::implausible;
    return agreeing_;
  }
  result->parallax = seen.parallax;
  if (stands) result->condition = OdometryCondition::standstill;
  offset_.update(motion.offset, motion.offset_sigma, result->inliers);
  remember(motion.T_previous_current, seconds, *result);
  if (parameters_.window_frames > 0) {
    adjust_window(tracks, &motion, result);
    notify(stage_, "window");
  }
  widen(tracks, motion, result);
  agreeing_.swap(motion.inliers);
  return agreeing_;
}

}  // namespace maploop::stereo
