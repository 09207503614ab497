// In a turn the origin of the body swings out of the direction in which the vehicle points.
#pragma once

#include <cmath>

#include "estimators/fusion/filter_state.h"

namespace maploop::fusion {

// Returns how far the origin is ahead of the point that moves along the azimuth, in m. This point
// lies before the rear axle, because tyres carry the vehicle around a turn only by slipping
// outwards: their slip angle is `rear_slip` (rad/(m/s^2)) times the lateral acceleration.
// (3) of METHOD.md
inline double swing_arm(double axle_distance, double rear_slip, double ground_speed) {
  return axle_distance - rear_slip * ground_speed * std::abs(ground_speed);
}
inline double swing_arm(const StateVector& x) {
  return swing_arm(x[index::axle_distance], x[index::rear_slip],
                   x[index::speed] / (1.0 + x[index::speed_scale]));
}

// Adds the derivatives with respect to the state of what changes by `per_arm` per metre of the arm
// to the rows H.
template <class Rows, class PerArm>
void add_swing_derivatives(const StateVector& x, const PerArm& per_arm, Rows&& H) {
  using namespace index;
  const double to_ground = 1.0 / (1.0 + x[speed_scale]);
  const double ground = x[speed] * to_ground;
  const double by_speed = -2.0 * x[rear_slip] * std::abs(ground) * to_ground;
  H.col(axle_distance) += per_arm;
  H.col(rear_slip) -= per_arm * (ground * std::abs(ground));
  H.col(speed) += per_arm * by_speed;
  H.col(speed_scale) -= per_arm * (by_speed * ground);
}

}  // namespace maploop::fusion
