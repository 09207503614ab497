// Computes whether the covariance of an odometry matches its errors.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "msgs/odometry.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::odometry {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Joins successive motions and adds their covariances as if they were independent: translation,
// then rotation vector, of the last frame in the first one.
struct JoinedMotion {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Matrix6 covariance = Matrix6::Zero();

  void append(const Eigen::Isometry3d& motion, const Matrix6& motion_covariance);
};

// Returns `estimate` minus `truth`, in the same order.
Eigen::Matrix<double, 6, 1> pose_difference(const Eigen::Isometry3d& estimate,
                                            const Eigen::Isometry3d& truth);

struct Consistency {
  double nees = 0.0;   // normalized estimation error squared per degree of freedom; 1 is ideal
  int increments = 0;  // number of increments in the mean
};

// Compares the motions of the body, joined to increments of at least `seconds`, with the left
// camera's truth at the same stamps; increments with a refused motion in them are left out. One
// rotation common to all poses between the truth's axes and the camera's is removed, and the
// truth's own error over such an increment is added to the covariance (KITTI's OXTS: 3 cm, 0.05
// degrees).
Consistency consistency(std::span<const RelativeMotion> motions,
                        const Eigen::Isometry3d& T_body_cam,
                        const evaluation::StampedTrajectory& truth, double seconds = 1.0);

}  // namespace maploop::odometry
