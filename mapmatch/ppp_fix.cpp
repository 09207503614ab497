#include "mapmatch/ppp_fix.h"

#include <cmath>

namespace maploop::mapmatch {

VehicleFix fix_of(const PppState& state) {
  constexpr double slowest = 1.0;  // m/s, below which a velocity has no direction
  VehicleFix fix;
  fix.stamp = state.stamp;
  fix.position = state.position;
  fix.covariance = state.position_covariance.topLeftCorner<2, 2>();
  const Eigen::Vector2d velocity = state.velocity_enu.head<2>();
  fix.speed = velocity.norm();
  if (!(fix.speed >= slowest)) return fix;
  const Eigen::Vector2d along = velocity / fix.speed, across(along.y(), -along.x());
  const Eigen::Matrix2d P = state.velocity_covariance.topLeftCorner<2, 2>();
  fix.speed_sigma = std::sqrt(along.dot(P * along));
  fix.azimuth = std::atan2(velocity.x(), velocity.y());
  fix.azimuth_sigma = std::sqrt(across.dot(P * across)) / fix.speed;
  return fix;
}

}  // namespace maploop::mapmatch
