// Poses from relative motions.
#pragma once

#include <Eigen/Geometry>
#include <map>

#include "msgs/odometry.h"

namespace maploop::evaluation {

// Each motion starts at the pose of its own `from`: one that spans refused ones takes the place of
// what was assumed for them, which is that the body goes on as it last went.
class MotionChain {
 public:
  // Pose of the body at the motion's stamp, in its first frame.
  const Eigen::Isometry3d& add(const RelativeMotion& motion);

 private:
  std::map<Time, Eigen::Isometry3d> poses_;
  Eigen::Isometry3d last_motion_ = Eigen::Isometry3d::Identity();
  Duration last_interval_ = std::chrono::seconds(1);
};

}  // namespace maploop::evaluation
