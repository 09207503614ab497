// Gathers the left camera's trajectories during a replay, and scores them against the reference.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <optional>

#include "msgs/nav_state.h"
#include "msgs/odometry.h"
#include "tools/evaluate/kitti_poses.h"
#include "tools/evaluate/motion_chain.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/replay/replay_result.h"

namespace maploop::tools {

// add() on the publisher's thread; the rest after the replay.
class TrajectoryCollector {
 public:
  explicit TrajectoryCollector(const Eigen::Isometry3d& T_body_cam) : T_body_cam_(T_body_cam) {}

  // Odometry is chained; through a refused motion it goes on as it last went.
  void add(const RelativeMotion& motion);
  // The fused state at an image.
  void add(const NavState& image_state);

  // Poses of the camera in `enu`, or in the first camera's frame, at the images that have one.
  evaluation::StampedTrajectory fused() const;

  // Odometry's poses of the body, in its first frame.
  evaluation::StampedTrajectory odometry() const;

  // Pose of the body at a stamp, where the reference has one.
  using Reference = std::function<std::optional<Eigen::Isometry3d>(Time)>;
  std::optional<Accuracy> score_vo(const Reference& reference) const;
  std::optional<Accuracy> score_fused(const Reference& reference) const;

 private:
  using Poses = std::map<Time, Eigen::Isometry3d>;
  std::optional<Accuracy> score(const Poses& poses, const Reference& reference) const;

  Eigen::Isometry3d T_body_cam_;
  evaluation::MotionChain chain_;
  Poses vo_;     // of the body, in its first frame
  Poses fused_;  // of the body, in enu
};

}  // namespace maploop::tools
