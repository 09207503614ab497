#include "estimators/fusion/initial_state.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimators/fusion/covariance_check.h"
#include "estimators/fusion/fix_error.h"
#include "estimators/fusion/measurement_check.h"
#include "estimators/fusion/stamp_guard.h"
#include "estimators/fusion/swing.h"

namespace maploop::fusion {
namespace {

// Returns the velocity of the rear axle, from which the antenna's differs by its swing in a turn.
// The body's axes, which the swing needs, follow from the velocity itself.
Eigen::Vector3d velocity_of_axle(const Eigen::Vector3d& antenna, double yaw_rate,
                                 const FusionParameters& p) {
  const double swing = swing_arm(p.rear_axle_distance, p.rear_slip, antenna.norm());
  const Eigen::Vector3d arm(p.gnss_lever_forward + swing, p.gnss_lever_left, 0.0);
  Eigen::Vector3d axle = antenna;
  for (int i = 0; i < 3; ++i) {
    const Attitude level{std::atan2(axle.x(), axle.y()), 0.0, 0.0};
    axle = antenna - rotation_enu_body(level) * Eigen::Vector3d(0.0, 0.0, yaw_rate).cross(arm);
  }
  return axle;
}

// Returns the largest standard deviation of the horizontal velocity, m/s.
double velocity_sigma(const GnssFix& fix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      fix.velocity_covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues().maxCoeff()));
}

// Corrects a velocity by what is known of roads: they climb by zero, give or take their slope. The
// rest of the velocity is corrected by its correlation with the error of the climb.
void keep_to_the_road(Eigen::Vector3d& velocity, Eigen::Matrix3d& covariance,
                      const FusionParameters& p) {
  const double climb = p.road_slope_sigma * velocity.head<2>().norm();
  // (39) of METHOD.md
  const Eigen::Vector3d gain = covariance.col(2) / (covariance(2, 2) + climb * climb);
  velocity -= gain * velocity.z();
  covariance -= (gain * covariance.row(2)).eval();
}

// Adds the variances that no start provides: biases, scales and the lasting error of fixes.
void add_unknown_sensors(FilterState& state, const FusionParameters& p) {
  using namespace index;
  const auto add = [&](int i, double sigma) { state.P(i, i) += sigma * sigma; };
  add(gyro_bias, p.gyro_turn_on_sigma);
  add(forward_bias, p.accelerometer_turn_on_sigma);
  add(left_bias, p.accelerometer_turn_on_sigma);
  if (p.uses_six_axes()) {
    add(roll_gyro_bias, p.gyro_turn_on_sigma);
    add(pitch_gyro_bias, p.gyro_turn_on_sigma);
    add(unit_course, p.unit_course_sigma);
    add(up_bias, p.accelerometer_turn_on_sigma);
  }
  // The speed over ground is given, but the state holds the speed as the sensor measures it.
  const double scale_variance = p.speed_scale_sigma * p.speed_scale_sigma;
  state.P(speed_scale, speed_scale) = scale_variance;
  state.P(speed, speed) += state.x[speed] * state.x[speed] * scale_variance;
  state.P(speed, speed_scale) = state.P(speed_scale, speed) = state.x[speed] * scale_variance;
  add(imu_delay, p.imu_delay_sigma);
  add(odometry_course, p.odometry_course_sigma);
  add(odometry_left, p.odometry_lever_sigma);
  state.x[axle_distance] = p.rear_axle_distance;
  add(axle_distance, p.rear_axle_sigma);
  state.x[rear_slip] = p.rear_slip;
  add(rear_slip, p.rear_slip_sigma);
  state.x.segment<3>(lever_forward) << p.gnss_lever_forward, p.gnss_lever_left, p.gnss_lever_up;
  for (int i = lever_forward; i <= lever_up; ++i) add(i, p.gnss_lever_sigma);
  add(gnss_delay, p.gnss_delay_sigma);
  add(lidar_scale, p.lidar_scale_sigma);
  add(lidar_turn, p.lidar_turn_sigma);
  for (int i = gnss_offset_east; i <= gnss_offset_up; ++i) add(i, 1.0);
  add(lane_offset, 1.0);
}

}  // namespace

Reason check_start(const KnownStart& k) {
  const Eigen::Vector3d position(k.position.latitude, k.position.longitude, k.position.height);
  const Eigen::Vector3d attitude(k.attitude.azimuth, k.attitude.pitch, k.attitude.roll);
  Eigen::Matrix<double, 9, 1> sigmas;
  sigmas << k.position_sigma, k.fix_offset_sigma, k.azimuth_sigma, k.tilt_sigma, k.speed_sigma;
  if (!position.allFinite() || !attitude.allFinite() || !sigmas.allFinite() ||
      !std::isfinite(k.speed) || !k.fix_offset.allFinite() ||
      !k.fix_offset_correlation.allFinite()) {
    return Reason::not_finite;
  }
  const bool possible = plausible_stamp(k.stamp) &&
                        std::abs(k.position.latitude) <= radians(89.0) &&
                        std::abs(k.attitude.pitch) < 1.0 && std::abs(k.attitude.roll) < 1.0 &&
                        std::abs(k.speed) <= 100.0 && sigmas.minCoeff() >= 0.0 &&
                        k.fix_offset_correlation.cwiseAbs().maxCoeff() <= 1.0;
  return possible ? Reason::none : Reason::out_of_range;
}

FilterState initial_state(const KnownStart& k, const LocalFrame& frame, const FusionParameters& p) {
  using namespace index;
  FilterState state;
  state.stamp = state.start = k.stamp;
  state.x.segment<3>(east) = frame.to_enu(k.position);
  state.x[speed] = k.speed;
  state.x[azimuth] = wrap_angle(k.attitude.azimuth);
  state.x[pitch] = k.attitude.pitch;
  state.x[roll] = k.attitude.roll;
  state.x[climb_offset] = p.climb_offset;
  const auto add = [&](int i, double sigma) { state.P(i, i) += sigma * sigma; };
  for (int i = east; i <= up; ++i) add(i, std::max(k.position_sigma[i], 1e-3));
  add(speed, std::max(k.speed_sigma, 1e-3));
  add(azimuth, std::max(k.azimuth_sigma, 1e-5));
  add(pitch, std::max(k.tilt_sigma, 1e-4));
  add(roll, std::max(k.tilt_sigma, 1e-4));
  add(climb_offset, p.climb_offset_sigma);
  add_unknown_sensors(state, p);
  for (int i = east; i <= up; ++i) {
    const int offset = gnss_offset_east + i;
    const double sigma = k.fix_offset_sigma[i];
    state.x[offset] = k.fix_offset[i];
    state.P(offset, offset) = sigma * sigma;
    state.P(i, offset) = state.P(offset, i) =
        k.fix_offset_correlation[i] * sigma * std::sqrt(state.P(i, i));
  }
  start_clone(state);
  return state;
}

Time start_stamp(const GnssFix& fix) {
  return std::min(fix.stamp, fix.velocity_stamp);
}

bool moves(const GnssFix& fix, const FusionParameters& parameters) {
  return fix.velocity_enu.head<2>().norm() >= parameters.min_course_speed;
}

Reason check_fix(const GnssFix& fix, const FusionParameters& parameters) {
  const Eigen::Vector3d position(fix.position.latitude, fix.position.longitude,
                                 fix.position.height);
  if (!position.allFinite() || !fix.velocity_enu.allFinite() ||
      !fix.position_covariance.allFinite() || !fix.velocity_covariance.allFinite()) {
    return Reason::not_finite;
  }
  if (!plausible_stamp(fix.stamp) || std::abs(fix.position.latitude) > radians(89.0) ||
      std::abs(fix.position.longitude) > radians(360.0) || std::abs(fix.position.height) > 10e3 ||
      fix.velocity_enu.norm() > 100.0) {
    return Reason::out_of_range;
  }
  if (!is_covariance(fix.position_covariance) || !is_covariance(fix.velocity_covariance)) {
    return Reason::invalid_covariance;
  }
  if (fix.increment) {
    const GnssIncrement& i = *fix.increment;
    if (!i.position.allFinite() || !i.velocity_enu.allFinite()) return Reason::not_finite;
    if (!is_covariance(i.position_covariance) || !is_covariance(i.velocity_covariance) ||
        !is_covariance(i.growth)) {
      return Reason::invalid_covariance;
    }
  }
  const Duration limit = from_seconds(parameters.max_stamp_offset);
  if (!plausible_stamp(fix.velocity_stamp) ||
      start_stamp(fix) < std::max(fix.stamp, fix.velocity_stamp) - limit) {
    return Reason::stamps_apart;
  }
  if (stamped_after_delivery(fix, parameters)) return Reason::after_delivery;
  if (!moves(fix, parameters) || velocity_sigma(fix) > parameters.max_course_velocity_sigma) {
    return Reason::no_course;
  }
  return Reason::none;
}

bool shows_late_course(const GnssFix& fix, const FusionParameters& parameters) {
  return moves(fix, parameters) &&
         velocity_sigma(fix) <= parameters.late_course_sigma * fix.velocity_enu.head<2>().norm();
}

FilterState initial_state(const GnssFix& fix, const LocalFrame& frame, const FusionParameters& p,
                          double yaw_rate) {
  using namespace index;
  const Time start = start_stamp(fix);
  const double position_age = to_seconds(fix.stamp - start);
  const double velocity_age = to_seconds(fix.velocity_stamp - start);
  Eigen::Vector3d antenna = fix.velocity_enu;
  Eigen::Matrix3d velocity_covariance = fix.velocity_covariance + p.min_velocity_sigma *
                                                                      p.min_velocity_sigma *
                                                                      Eigen::Matrix3d::Identity();
  keep_to_the_road(antenna, velocity_covariance, p);
  const Eigen::Vector3d v = velocity_of_axle(antenna, yaw_rate, p);
  const double horizontal = v.head<2>().norm();
  const double length = v.norm();

  FilterState state;
  state.stamp = state.start = start;
  state.x.segment<3>(east) = frame.to_enu(fix.position) - position_age * v;
  state.x[speed] = length;
  state.x[azimuth] = std::atan2(v.x(), v.y());
  state.x[pitch] = std::atan2(v.z(), horizontal) - p.climb_offset;
  state.x[climb_offset] = p.climb_offset;

  // J is the derivative of position, speed, azimuth and pitch with respect to the fix's position
  // and velocity.
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
  J.block<3, 3>(0, 0).setIdentity();
  J.block<3, 3>(0, 3) = -position_age * Eigen::Matrix3d::Identity();
  J.block<1, 3>(3, 3) = v.transpose() / length;
  J.block<1, 3>(4, 3) << v.y() / (horizontal * horizontal), -v.x() / (horizontal * horizontal), 0;
  J.block<1, 3>(5, 3) << -v.z() * v.x() / (length * length * horizontal),
      -v.z() * v.y() / (length * length * horizontal), horizontal / (length * length);
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>() = fix.position_covariance;
  C.bottomRightCorner<3, 3>() = velocity_covariance;
  C.diagonal().head<3>().array() += p.min_position_sigma * p.min_position_sigma;

  // The pitch is the climb minus the climb offset.
  static_assert(speed == 3 && azimuth == 4 && pitch == 5 && roll == 6);
  state.P.topLeftCorner<6, 6>() = J * C * J.transpose();
  const auto add = [&](int i, double sigma) { state.P(i, i) += sigma * sigma; };
  add(speed, p.start_acceleration * velocity_age);
  add(azimuth, p.start_course_sigma);
  add(pitch, std::hypot(p.start_slope_sigma, p.climb_offset_sigma));
  add(climb_offset, p.climb_offset_sigma);
  state.P(pitch, climb_offset) = -p.climb_offset_sigma * p.climb_offset_sigma;
  state.P(climb_offset, pitch) = state.P(pitch, climb_offset);
  add(roll, p.start_roll_sigma);
  add_unknown_sensors(state, p);
  // The fix is the position of the antenna, at the time that it is of.
  const Eigen::Matrix3d R = rotation_enu_body(state.attitude());
  const Eigen::Vector3d arm = R * state.gnss_lever();
  StateMatrix to_origin = StateMatrix::Identity();
  to_origin.block<3, 3>(east, lever_forward) = -R;
  to_origin.block<3, 3>(east, azimuth) = -turned_by_attitude(state.attitude(), arm);
  to_origin.block<3, 1>(east, gnss_delay) = v;
  state.x.segment<3>(east) -= arm;
  state.P = (to_origin * state.P * to_origin.transpose()).eval();
  // The lasting part of this fix's error is in the start position and also in later fixes.
  const Eigen::Matrix3d lasting = split_error(fix.position_covariance, p).lasting;
  state.P.block<3, 3>(east, gnss_offset_east) = -lasting;
  state.P.block<3, 3>(gnss_offset_east, east) = -lasting.transpose();
  state.gnss_stamp = fix.stamp;
  start_clone(state);
  return state;
}

}  // namespace maploop::fusion
