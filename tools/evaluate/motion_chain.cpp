#include "tools/evaluate/motion_chain.h"

#include <iterator>

namespace maploop::evaluation {
namespace {

// Returns the motion with the same velocities during another time. The rotation between images is
// small.
Eigen::Isometry3d scaled(const Eigen::Isometry3d& motion, double factor) {
  Eigen::AngleAxisd turn(motion.linear());
  turn.angle() *= factor;
  return Eigen::Translation3d(factor * motion.translation()) * Eigen::Isometry3d(turn);
}

}  // namespace

// Returns the motion up to `stamp` at the velocities between the last two poses before `next`.
Eigen::Isometry3d MotionChain::gone_on(Poses::const_iterator next, Time stamp) const {
  if (std::prev(next) == poses_.begin()) return Eigen::Isometry3d::Identity();
  const auto& [last_stamp, last] = *std::prev(next);
  const auto& [stamp_before, before] = *std::prev(next, 2);
  return scaled(before.inverse() * last,
                to_seconds(stamp - last_stamp) / to_seconds(last_stamp - stamp_before));
}

const Eigen::Isometry3d& MotionChain::add(const RelativeMotion& motion) {
  const auto next = poses_.lower_bound(motion.stamp);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (next != poses_.begin()) pose = std::prev(next)->second;
  if (motion.status == OdometryStatus::ok) {
    const Eigen::Isometry3d T_from_to = motion.T_from_to();
    const auto from = poses_.find(motion.from);
    if (from != poses_.end()) {
      pose = from->second;
    } else if (next != poses_.begin() && motion.from > std::prev(next)->first) {
      pose = pose * scaled(T_from_to, to_seconds(motion.from - std::prev(next)->first) /
                                          to_seconds(motion.stamp - motion.from));
    }
    pose = pose * T_from_to;
  } else if (next != poses_.begin()) {
    pose = pose * gone_on(next, motion.stamp);
  }
  return poses_[motion.stamp] = pose;
}

}  // namespace maploop::evaluation
