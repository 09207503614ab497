#include "estimators/stereo/back_end.h"

#include "estimators/stereo/plausibility.h"

namespace maploop::stereo {

BackEnd::BackEnd(const StereoCalibration& calibration, const StereoParameters& parameters)
    : camera_(calibration), parameters_(parameters), offset_(parameters) {}

// Constant velocity: the last motion, stretched.
std::optional<Eigen::Isometry3d> BackEnd::expected_motion(double seconds) const {
  if (!last_velocity_) return std::nullopt;
  const double ratio = seconds / last_seconds_;
  const Eigen::AngleAxisd turn(last_motion_.linear());
  Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
  expected.linear() = Eigen::AngleAxisd(turn.angle() * ratio, turn.axis()).toRotationMatrix();
  expected.translation() = last_motion_.translation() * ratio;
  return expected;
}

const std::vector<int>& BackEnd::process(std::span<const StereoTrack> tracks,
                                         RelativeMotion* result) {
  const double seconds = to_seconds(result->stamp - result->from);
  offset_.predict(seconds);
  CameraMotion motion = estimate_motion(camera_, parameters_, tracks,
                                        static_cast<std::uint64_t>(to_nanoseconds(result->stamp)),
                                        offset_, expected_motion(seconds));
  result->tracked = motion.tracked;
  result->inliers = static_cast<int>(motion.inliers.size());
  result->status = motion.status;
  if (motion.status == OdometryStatus::ok) {
    RelativeMotion in_body;
    to_body(camera_.T_body_cam, motion, &in_body);
    if (plausible(in_body, seconds, last_velocity_, parameters_)) {
      result->translation = in_body.translation;
      result->rotation = in_body.rotation;
      result->covariance = in_body.covariance;
    } else {
      result->status = OdometryStatus::implausible;
    }
  }
  remember(motion, *result, seconds);
  agreeing_.clear();
  if (result->status == OdometryStatus::ok) agreeing_.swap(motion.inliers);
  return agreeing_;
}

void BackEnd::remember(const CameraMotion& motion, const RelativeMotion& result, double seconds) {
  if (result.status == OdometryStatus::ok) {
    last_motion_ = motion.T_previous_current;
    last_velocity_ = result.translation / seconds;
    last_seconds_ = seconds;
    offset_.update(motion.offset, motion.offset_sigma, result.inliers);
  } else {
    last_velocity_.reset();  // it may be the one that was wrong
  }
}

}  // namespace maploop::stereo
