#include "estimators/stereo/plausibility.h"

#include <cmath>

namespace maploop::stereo {

Eigen::Vector3d angular_velocity(const RelativeMotion& motion, double seconds) {
  const Eigen::AngleAxisd turn(motion.rotation);
  return turn.angle() / seconds * turn.axis();
}

bool plausible(const RelativeMotion& motion, double seconds,
               const std::optional<LastVelocity>& last, const StereoParameters& parameters) {
  const Eigen::Vector3d velocity = motion.translation / seconds;
  if (!(velocity.norm() <= parameters.max_speed)) return false;

  const double yaw = 2.0 * std::atan2(motion.rotation.z(), motion.rotation.w());
  if (!(std::abs(std::remainder(yaw, 2.0 * M_PI)) <= parameters.max_yaw_rate * seconds))
    return false;

  if (!last) return true;
  const auto noise = [&](Eigen::Index first) {
    return 3.0 * std::sqrt(motion.covariance.diagonal().segment<3>(first).sum()) / seconds;
  };
  return (velocity - last->linear).norm() <= parameters.max_acceleration * last->age + noise(0) &&
         (angular_velocity(motion, seconds) - last->angular).norm() <=
             parameters.max_turn_acceleration * last->age + noise(3);
}

}  // namespace maploop::stereo
