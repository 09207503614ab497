#include "estimators/fusion/nav_state_output.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimators/fusion/swing.h"

namespace maploop::fusion {
namespace {

Eigen::Vector3d direction_of_travel(const StateVector& x) {
  return direction(x[index::azimuth], x[index::pitch] + x[index::climb_offset]);
}

Eigen::Vector3d left_of(const StateVector& x) {
  return {-std::cos(x[index::azimuth]), std::sin(x[index::azimuth]), 0.0};
}

}  // namespace

Eigen::Matrix<double, 9, index::count> nav_state_jacobian(const FilterState& state) {
  using namespace index;
  const StateVector& x = state.x;
  const double sA = std::sin(x[azimuth]), cA = std::cos(x[azimuth]);
  const double climb = x[pitch] + x[climb_offset];
  const double sc = std::sin(climb), cc = std::cos(climb);
  Eigen::Matrix<double, 9, count> J = Eigen::Matrix<double, 9, count>::Zero();
  const double to_ground = 1.0 / (1.0 + x[speed_scale]);
  const double ground = x[speed] * to_ground;
  const Eigen::Vector3d travel = direction_of_travel(x);
  J.block<3, 3>(0, east).setIdentity();
  J.block<3, 1>(3, speed) = to_ground * travel;
  J.block<3, 1>(3, speed_scale) = -ground * to_ground * travel;
  J.block<3, 1>(3, azimuth) << ground * cA * cc, -ground * sA * cc, 0.0;
  J.block<3, 1>(3, pitch) << -ground * sA * sc, -ground * cA * sc, ground * cc;
  J.block<3, 1>(3, climb_offset) = J.block<3, 1>(3, pitch);
  const double rate = state.yaw_rate - x[gyro_bias];
  const double arm = swing_arm(x);
  add_swing_derivatives(x, rate * left_of(x), J.middleRows<3>(3));
  J.block<3, 1>(3, gyro_bias) = -arm * left_of(x);
  J.block<2, 1>(3, azimuth) +=
      rate * arm * Eigen::Vector2d(std::sin(x[azimuth]), std::cos(x[azimuth]));
  J.block<3, 3>(6, azimuth).setIdentity();
  return J;
}

NavState nav_state(const FilterState& state, const Geodetic& origin,
                   const FusionParameters& parameters) {
  NavState nav;
  nav.stamp = nav.available = state.stamp;
  const Time aided_since = std::max({state.odometry_stamp, state.wheel_stamp,
                                     parameters.use_gnss ? state.gnss_stamp : Time{}, state.start});
  nav.status = state.stamp - aided_since > from_seconds(parameters.coasting_after)
                   ? NavStatus::coasting
                   : NavStatus::aided;
  nav.origin = origin;
  nav.position_enu = state.x.segment<3>(index::east);
  nav.forward_speed = state.ground_speed();
  nav.attitude = state.attitude();
  nav.gyro_bias = state.x[index::gyro_bias];

  const Eigen::Matrix<double, 9, index::count> J = nav_state_jacobian(state);
  const Eigen::Vector3d travel = direction_of_travel(state.x);
  nav.velocity_enu = nav.forward_speed * travel + (state.yaw_rate - state.x[index::gyro_bias]) *
                                                      swing_arm(state.x) * left_of(state.x);
  const Eigen::Matrix<double, 9, 9> covariance = J * state.P * J.transpose();
  nav.covariance = 0.5 * (covariance + covariance.transpose());
  const double slip = parameters.slip_sigma * nav.forward_speed;
  nav.covariance.block<3, 3>(3, 3) +=
      slip * slip * (Eigen::Matrix3d::Identity() - travel * travel.transpose());

  nav.imu_stamp = state.imu_stamp;
  nav.odometry_stamp = state.odometry_stamp;
  nav.gnss_stamp = state.gnss_stamp;
  nav.wheel_stamp = state.wheel_stamp;
  nav.zero_velocity_stamp = state.zero_velocity_stamp;
  nav.reinitializations = state.reinitializations;
  nav.odometry_applied = state.odometry_applied;
  nav.odometry_refused = state.odometry_refused;
  return nav;
}

FusedState fused_state(const FilterState& state, const Geodetic& origin,
                       const FusionParameters& parameters) {
  FusedState fused;
  static_cast<NavState&>(fused) = nav_state(state, origin, parameters);
  static_cast<Sample&>(fused.odom) = fused;
  fused.odom.status = fused.status;
  const OdomPose pose = state.odom();
  fused.odom.position = pose.position;
  fused.odom.attitude = attitude_from_rotation(pose.rotation.toRotationMatrix());
  fused.odom.velocity_body = rotation_enu_body(fused.attitude).transpose() * fused.velocity_enu;
  fused.odom.yaw_rate = state.yaw_rate - state.x[index::gyro_bias];
  fused.mount = state.mount();
  return fused;
}

FusedState state_without_course(const GnssFix& fix, Time t, const LocalFrame& frame,
                                const FusionParameters& p) {
  const double age = to_seconds(t - fix.stamp);
  const Eigen::Matrix3d velocity_covariance =
      fix.velocity_covariance +
      p.min_velocity_sigma * p.min_velocity_sigma * Eigen::Matrix3d::Identity();
  const double moved = 0.5 * p.start_acceleration * age * age;

  FusedState state;
  state.stamp = state.available = t;
  state.status = NavStatus::without_course;
  state.origin = frame.origin();
  state.position_enu = frame.to_enu(fix.position) + age * fix.velocity_enu -
                       p.gnss_lever_up * Eigen::Vector3d::UnitZ();
  state.velocity_enu = fix.velocity_enu;
  state.forward_speed = fix.velocity_enu.norm();
  auto position = state.covariance.topLeftCorner<3, 3>();
  position = fix.position_covariance + age * age * velocity_covariance;
  position.diagonal().array() += p.min_position_sigma * p.min_position_sigma + moved * moved;
  const double arm = std::hypot(p.gnss_lever_forward, p.gnss_lever_left);
  position.diagonal().head<2>().array() += 0.5 * arm * arm;
  state.covariance.block<3, 3>(3, 3) = velocity_covariance;
  const double accelerated = p.start_acceleration * age;
  state.covariance.diagonal().segment<3>(3).array() += accelerated * accelerated;
  constexpr double any_direction = std::numbers::pi / std::numbers::sqrt3;  // rad, sigma
  const Eigen::Vector3d angles(any_direction, std::hypot(p.start_slope_sigma, p.climb_offset_sigma),
                               p.start_roll_sigma);
  state.covariance.diagonal().tail<3>() = angles.cwiseAbs2();
  state.gnss_stamp = fix.stamp;
  static_cast<Sample&>(state.odom) = state;
  return state;
}

}  // namespace maploop::fusion
