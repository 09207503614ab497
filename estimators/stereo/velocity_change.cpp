#include "estimators/stereo/velocity_change.h"

#include <cmath>

#include "estimators/stereo/residual.h"
#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Returns the inverse of the left Jacobian of SO(3) (Sola, Deray, Atchuthan, "A micro Lie theory",
// 2018, eq. 146).
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d cross = cross_matrix(rotation);
  const double factor =
      angle < 1e-3
          ? 1.0 / 12.0
          : (1.0 - angle * (1.0 + std::cos(angle)) / (2.0 * std::sin(angle))) / (angle * angle);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

struct Velocity {
  Eigen::Matrix<double, 6, 1> value;
  Matrix6 by_from, by_to;
};

Velocity velocity(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double seconds) {
  const Eigen::Matrix3d R = from.linear().transpose() / seconds;
  const Eigen::Vector3d step = to.translation() - from.translation();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(from.linear().transpose() * to.linear()));
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  const Eigen::Matrix3d by_rotation = inverse_left_jacobian(rotation) * R;

  Velocity v;
  v.value << R * step, rotation / seconds;
  v.by_from.setZero();
  v.by_to.setZero();
  v.by_from.topLeftCorner<3, 3>() = -R;
  v.by_to.topLeftCorner<3, 3>() = R;
  v.by_from.topRightCorner<3, 3>() = R * cross_matrix(step);
  v.by_from.bottomRightCorner<3, 3>() = -by_rotation;
  v.by_to.bottomRightCorner<3, 3>() = by_rotation;
  return v;
}

}  // namespace

VelocityChange velocity_change(const std::array<Eigen::Isometry3d, 3>& poses,
                               const std::array<double, 2>& seconds) {
  const Velocity first = velocity(poses[0], poses[1], seconds[0]);
  const Velocity second = velocity(poses[1], poses[2], seconds[1]);
  return {second.value - first.value, {-first.by_from, second.by_from - first.by_to, second.by_to}};
}

}  // namespace maploop::stereo
