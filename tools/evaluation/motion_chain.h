// Poses from relative motions.
#pragma once

#include <Eigen/Geometry>
#include <map>

#include "msgs/odometry.h"

namespace maploop::evaluation {

// Each motion starts at the pose of its own `from`: one that spans refused ones takes the place of
// what was assumed for them, which is that the body goes on as it last went. Motions may come again
// from an earlier one on, as where a replay goes back.
class MotionChain {
 public:
  // Pose of the body at the motion's stamp, in its first frame.
  const Eigen::Isometry3d& add(const RelativeMotion& motion);

 private:
  using Poses = std::map<Time, Eigen::Isometry3d>;
  Eigen::Isometry3d gone_on(Poses::const_iterator next, Time stamp) const;

  Poses poses_;
};

}  // namespace maploop::evaluation
