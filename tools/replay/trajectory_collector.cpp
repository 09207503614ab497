#include "tools/replay/trajectory_collector.h"

#include "msgs/frames.h"

namespace maploop::tools {

void TrajectoryCollector::add(const RelativeMotion& motion) {
  vo_[motion.stamp] = chain_.add(motion);
}

void TrajectoryCollector::add(const NavState& state) {
  const Eigen::Isometry3d T_enu_body = Eigen::Translation3d(state.position_enu) *
                                       Eigen::Isometry3d(rotation_enu_body(state.attitude));
  fused_[state.stamp] = T_enu_body;
}

evaluation::StampedTrajectory TrajectoryCollector::fused() const {
  evaluation::StampedTrajectory trajectory;
  for (const auto& [stamp, pose] : fused_) {
    trajectory.stamps.push_back(stamp);
    trajectory.poses.push_back(pose * T_body_cam_);
  }
  return trajectory;
}

evaluation::StampedTrajectory TrajectoryCollector::odometry() const {
  evaluation::StampedTrajectory trajectory;
  for (const auto& [stamp, pose] : vo_) {
    trajectory.stamps.push_back(stamp);
    trajectory.poses.push_back(pose);
  }
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
