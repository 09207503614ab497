// Computes poses from relative motions.
#pragma once

#include <Eigen/Geometry>
#include <map>

#include "msgs/odometry.h"

namespace maploop::evaluation {

// Each motion starts at the pose of its own `from`. Where there is none, as of a scan that begins
// some time after the one before has ended, the time between is driven as the motion. For refused
// motions, the body is assumed to keep its last velocities; a motion that spans them replaces this
// assumption. Motions may be repeated from an earlier one on, for instance if a replay seeks back.
class MotionChain {
 public:
  // Returns the pose of the body at the motion's stamp, in its first frame.
  const Eigen::Isometry3d& add(const RelativeMotion& motion);

 private:
  using Poses = std::map<Time, Eigen::Isometry3d>;
  Eigen::Isometry3d gone_on(Poses::const_iterator next, Time stamp) const;

  Poses poses_;
};

}  // namespace maploop::evaluation
