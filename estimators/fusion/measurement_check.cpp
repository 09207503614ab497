#include "estimators/fusion/measurement_check.h"

#include <Eigen/Core>
#include <cmath>

#include "estimators/fusion/covariance_check.h"
#include "estimators/fusion/stamp_guard.h"

namespace maploop::fusion {

bool stamped_after_delivery(const Sample& sample, const FusionParameters& parameters) {
  return plausible_stamp(sample.available) && plausible_stamp(sample.stamp) &&
         sample.stamp > sample.available + from_seconds(parameters.max_stamp_ahead);
}

Reason check_sample(const ImuSample& sample, const FusionParameters& parameters) {
  Eigen::Vector3d force(sample.specific_force_forward, sample.specific_force_left, 0.0);
  Eigen::Vector3d rate(0.0, 0.0, sample.yaw_rate);
  if (sample.six_axes && parameters.uses_six_axes()) {
    force.z() = sample.specific_force_up;
    rate.head<2>() << sample.roll_rate, sample.pitch_rate;
  }
  if (!force.allFinite() || !rate.allFinite()) return Reason::not_finite;
  if (force.cwiseAbs().maxCoeff() > parameters.max_specific_force ||
      rate.cwiseAbs().maxCoeff() > parameters.max_yaw_rate) {
    return Reason::out_of_range;
  }
  return stamped_after_delivery(sample, parameters) ? Reason::after_delivery : Reason::none;
}

Reason check_wheel(const WheelSpeed& sample, const FusionParameters& parameters) {
  if (!std::isfinite(sample.speed) || !std::isfinite(sample.sigma)) return Reason::not_finite;
  constexpr double max_speed = 100.0;  // m/s
  if (std::abs(sample.speed) > max_speed) return Reason::out_of_range;
  if (sample.sigma < 0.0) return Reason::invalid_covariance;
  return stamped_after_delivery(sample, parameters) ? Reason::after_delivery : Reason::none;
}

Reason check_motion(const RelativeMotion& motion, const FusionParameters& parameters) {
  if (stamped_after_delivery(motion, parameters)) return Reason::after_delivery;
  if (motion.status == OdometryStatus::bad_input) return Reason::odometry_not_ok;
  if (motion.status != OdometryStatus::ok) return Reason::none;
  if (!plausible_stamp(motion.stamp)) return Reason::out_of_range;
  if (!plausible_stamp(motion.from) || motion.stamp <= motion.from ||
      motion.stamp - motion.from > from_seconds(parameters.max_interval)) {
    return Reason::bad_interval;
  }
  if (!motion.translation.allFinite() || !motion.rotation.coeffs().allFinite() ||
      !motion.covariance.allFinite()) {
    return Reason::not_finite;
  }
  constexpr double rounding = 1e-3;
  constexpr double max_speed = 100.0;  // m/s; smaller errors are left to the gate
  if (std::abs(motion.rotation.norm() - 1.0) > rounding ||
      motion.translation.norm() > max_speed * to_seconds(motion.stamp - motion.from)) {
    return Reason::out_of_range;
  }
  if (!is_covariance(motion.covariance)) return Reason::invalid_covariance;
  return Reason::none;
}

}  // namespace maploop::fusion
