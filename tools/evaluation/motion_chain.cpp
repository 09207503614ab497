#include "tools/evaluation/motion_chain.h"

namespace maploop::evaluation {
namespace {

// The same velocities for another time. The rotation between images is small.
Eigen::Isometry3d scaled(const Eigen::Isometry3d& motion, double factor) {
  Eigen::AngleAxisd turn(motion.linear());
  turn.angle() *= factor;
  return Eigen::Translation3d(factor * motion.translation()) * Eigen::Isometry3d(turn);
}

}  // namespace

const Eigen::Isometry3d& MotionChain::add(const RelativeMotion& motion) {
  Eigen::Isometry3d pose = poses_.empty() ? Eigen::Isometry3d::Identity() : poses_.rbegin()->second;
  if (motion.status == OdometryStatus::ok) {
    last_motion_ = motion.T_from_to();
    last_interval_ = motion.stamp - motion.from;
    const auto from = poses_.find(motion.from);
    pose = (from == poses_.end() ? pose : from->second) * last_motion_;
  } else if (!poses_.empty() && motion.stamp > poses_.rbegin()->first) {
    const Duration since = motion.stamp - poses_.rbegin()->first;
    pose = pose * scaled(last_motion_, to_seconds(since) / to_seconds(last_interval_));
  }
  return poses_[motion.stamp] = pose;
}

}  // namespace maploop::evaluation
