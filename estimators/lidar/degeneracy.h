// Finds the directions that a registration does not determine (Zhang, Kaess and Singh, "On
// Degeneracy of Optimization-based State Estimation Problems", ICRA 2016).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace maploop::lidar {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Degeneracy {
  // The eigenvalues are ascending; each is the share of the points that would have to face this
  // direction to give the same information.
  Vector6d eigenvalues = Vector6d::Zero();
  Matrix6d seen = Matrix6d::Identity();  // projects a step onto the determined directions
  Matrix6d inverse = Matrix6d::Zero();   // inverse information in the determined directions
  std::uint8_t directions = 0;           // bit MotionDirection of each undetermined direction
};

// `information` is that of a step (translation in m, rotation in rad, in body) from `points`
// points, in units of one point's information along its normal. Rotations are converted to metres
// at `range` (m). A direction with less than `min_information` is not determined.
Degeneracy find_degeneracy(const Matrix6d& information, int points, double range,
                           double min_information);

}  // namespace maploop::lidar
