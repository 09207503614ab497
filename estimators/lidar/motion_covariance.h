// These functions transform covariances of motions: translation (m), then rotation vector (rad).
#pragma once

#include <Eigen/Geometry>

#include "estimators/lidar/degeneracy.h"

namespace maploop::lidar {

// Transforms from body axes at the motion's end (right perturbation) to those at its start.
inline Matrix6d to_from_axes(const Matrix6d& covariance, const Eigen::Matrix3d& R_from_to) {
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = R_from_to;
  return A * covariance * A.transpose();
}

// Returns the covariance of the same perturbation after a further motion T, in the axes at its end.
inline Matrix6d carried_over(const Matrix6d& covariance, const Eigen::Isometry3d& T) {
  const Eigen::Isometry3d back = T.inverse();
  const Eigen::Vector3d t = back.translation();
  Eigen::Matrix3d cross;
  cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = back.linear();
  A.topRightCorner<3, 3>() = cross * back.linear();
  return A * covariance * A.transpose();
}

}  // namespace maploop::lidar
