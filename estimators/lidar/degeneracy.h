// In which directions a registration says nothing (Zhang, Kaess and Singh, "On Degeneracy of
// Optimization-based State Estimation Problems", ICRA 2016).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace maploop::lidar {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Degeneracy {
  // Ascending: the share of the points that would have to face a direction to say as much of it.
  Vector6d eigenvalues = Vector6d::Zero();
  Matrix6d seen = Matrix6d::Identity();  // takes a step to its part that the points determine
  Matrix6d inverse = Matrix6d::Zero();   // of the information, on that part
  std::uint8_t directions = 0;           // bit MotionDirection of each direction not determined
};

// `information` of a step (translation in m, rotation in rad, in body) from `points` points, in
// units of what one point says along its normal. Rotations are compared as metres at `range`.
Degeneracy find_degeneracy(const Matrix6d& information, int points, double range,
                           double min_information);

}  // namespace maploop::lidar
