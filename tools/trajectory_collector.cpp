#include "tools/trajectory_collector.h"

#include <iterator>

#include "msgs/frames.h"

namespace maploop::tools {
namespace {

// The same velocities for another time. The rotation between images is small.
Eigen::Isometry3d scaled(const Eigen::Isometry3d& motion, double factor) {
  Eigen::AngleAxisd turn(motion.linear());
  turn.angle() *= factor;
  return Eigen::Translation3d(factor * motion.translation()) * Eigen::Isometry3d(turn);
}

}  // namespace

// The motion up to `stamp` at the velocities between the last two poses before `next`.
Eigen::Isometry3d TrajectoryCollector::gone_on(Poses::const_iterator next, Time stamp) const {
  if (next == vo_.begin() || std::prev(next) == vo_.begin()) return Eigen::Isometry3d::Identity();
  const auto& [last_stamp, last] = *std::prev(next);
  const auto& [stamp_before, before] = *std::prev(next, 2);
  return scaled(before.inverse() * last,
                to_seconds(stamp - last_stamp) / to_seconds(last_stamp - stamp_before));
}

void TrajectoryCollector::add(const RelativeMotion& motion) {
  // From the pose before, which is not the last one added where the replay has gone back.
  const auto next = vo_.lower_bound(motion.stamp);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (next != vo_.begin()) pose = std::prev(next)->second;
  if (motion.status == OdometryStatus::ok) {
    pose = pose * motion.T_from_to();
  } else {
    pose = pose * gone_on(next, motion.stamp);
  }
  vo_[motion.stamp] = pose;
}

void TrajectoryCollector::add(const NavState& state) {
  const Eigen::Isometry3d T_enu_body = Eigen::Translation3d(state.position_enu) *
                                       Eigen::Isometry3d(rotation_enu_body(state.attitude));
  fused_[state.stamp] = T_enu_body;
}

evaluation::Trajectory TrajectoryCollector::fused() const {
  evaluation::Trajectory trajectory;
  for (const auto& [stamp, pose] : fused_) trajectory.push_back(pose * T_body_cam_);
  return trajectory;
}

std::optional<Accuracy> TrajectoryCollector::score_vo(const Reference& reference) const {
  return score(vo_, reference);
}

std::optional<Accuracy> TrajectoryCollector::score_fused(const Reference& reference) const {
  return score(fused_, reference);
}

std::optional<Accuracy> TrajectoryCollector::score(const Poses& poses,
                                                   const Reference& reference) const {
  constexpr double segment_m = 100.0;
  evaluation::Trajectory estimate;
  evaluation::Trajectory truth;
  for (const auto& [stamp, body] : poses) {
    if (const auto T_enu_body = reference(stamp)) {
      estimate.push_back(body * T_body_cam_);
      truth.push_back(*T_enu_body * T_body_cam_);
    }
  }
  if (estimate.size() < 2) return std::nullopt;
  return Accuracy{
      evaluation::score(estimate, truth, segment_m, evaluation::CommonRotation::kKeep),
      evaluation::score(estimate, truth, segment_m, evaluation::CommonRotation::kRemove)};
}

}  // namespace maploop::tools
