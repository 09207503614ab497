#include "estimators/stereo/plausibility.h"

#include <cmath>

namespace maploop::stereo {

bool plausible(const RelativeMotion& motion, double seconds,
               const std::optional<Eigen::Vector3d>& last_velocity,
               const StereoParameters& parameters) {
  const Eigen::Vector3d velocity = motion.translation / seconds;
  if (!(velocity.norm() <= parameters.max_speed)) return false;

  const double yaw = 2.0 * std::atan2(motion.rotation.z(), motion.rotation.w());
  if (!(std::abs(std::remainder(yaw, 2.0 * M_PI)) <= parameters.max_yaw_rate * seconds))
    return false;

  if (!last_velocity) return true;
  const double noise = 3.0 * std::sqrt(motion.covariance.topLeftCorner<3, 3>().trace()) / seconds;
  return (velocity - *last_velocity).norm() <= parameters.max_acceleration * seconds + noise;
}

}  // namespace maploop::stereo
