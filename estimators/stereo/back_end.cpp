#include "estimators/stereo/back_end.h"

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

// Constant velocity: the last motion, stretched.
std::optional<Eigen::Isometry3d> BackEnd::expected_motion(Time stamp, double seconds) const {
  if (!known(stamp)) return std::nullopt;
  const double ratio = seconds / last_seconds_;
  const Eigen::AngleAxisd turn(last_motion_.linear());
  Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
  expected.linear() = Eigen::AngleAxisd(turn.angle() * ratio, turn.axis()).toRotationMatrix();
  expected.translation() = last_motion_.translation() * ratio;
  return expected;
}

// The motion in the body, if a road vehicle can make it.
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

void BackEnd::adjust_window(std::span<const StereoTrack> tracks, CameraMotion* motion,
                            const RelativeMotion& result) {
  if (window_.empty() || window_.newest().stamp != result.from) {
    window_.clear();
    window_.poses.push_back({result.from, Eigen::Isometry3d::Identity()});
  }
  const Eigen::Isometry3d before = window_.newest().T_world_cam;
  window_.add(camera_, result.stamp, before * motion->T_previous_current, tracks, motion->inliers,
              offset_.value());
  if (adjustment_.adjust(&window_)) {
    motion->T_previous_current = before.inverse() * window_.newest().T_world_cam;
  } else {
    window_.clear();
  }
}

const std::vector<int>& BackEnd::process(std::span<const StereoTrack> tracks,
                                         RelativeMotion* result) {
  const double seconds = to_seconds(result->stamp - result->from);
  offset_.predict(seconds);
  CameraMotion motion = estimate_motion(camera_, parameters_, tracks,
                                        static_cast<std::uint64_t>(to_nanoseconds(result->stamp)),
                                        offset_, expected_motion(result->stamp, seconds));
  result->tracked = motion.tracked;
  result->inliers = static_cast<int>(motion.inliers.size());
  result->status = motion.status;
  agreeing_.clear();
  if (result->status != OdometryStatus::ok) return agreeing_;
  if (!accept(motion, seconds, result)) {
    result->status = OdometryStatus::implausible;
    return agreeing_;
  }
  last_motion_ = motion.T_previous_current;
  last_stamp_ = result->stamp;
  last_seconds_ = seconds;
  last_velocity_ = {result->translation / seconds, angular_velocity(*result, seconds), 0.0};
  moved_ = true;
  offset_.update(motion.offset, motion.offset_sigma, result->inliers);
  if (parameters_.window_frames > 0) {
    adjust_window(tracks, &motion, *result);
    to_body(camera_.T_body_cam, motion, result);
  }
  agreeing_.swap(motion.inliers);
  return agreeing_;
}

}  // namespace maploop::stereo
