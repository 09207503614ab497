// This is the state of the reduced-IMU filter (a total-state EKF in local metres).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "estimators/fusion/contradiction.h"
#include "estimators/fusion/refused_fixes.h"
#include "estimators/fusion/wheel_check.h"
#include "msgs/frames.h"
#include "msgs/odom_state.h"
#include "msgs/time.h"

namespace maploop::fusion {

// These indices define the order of the state vector.
namespace index {
enum : int {
  east,
  north,
  up,            // m, enu
  speed,         // m/s along the path, as the speed sensor measures it; negative in reverse
  azimuth,       // rad, in (-pi, pi]
  pitch,         // rad
  roll,          // rad
  gyro_bias,     // rad/s, adds to the measured yaw rate
  forward_bias,  // m/s^2, adds to the measured forward specific force
  left_bias,     // m/s^2, adds to the measured left specific force
  // These four belong to a unit of six axes.
  roll_gyro_bias,   // rad/s, adds to the measured rate about body x
  pitch_gyro_bias,  // rad/s, adds to the measured rate about body y
  unit_course,      // rad, the unit points to the left of the direction of travel
  up_bias,          // m/s^2, adds to the measured upward specific force
  imu_delay,        // s, inertial data is later than its stamps, against odometry
  climb_offset,     // rad, direction of travel above body x, from mounting and load
  odometry_course,  // rad, odometry's motions point to the right of the travel, from its mounting
  odometry_left,    // m, the place that odometry is from is described too far to the left
  axle_distance,    // m, from the rear axle forward to the origin of the body
  rear_slip,        // rad/(m/s^2), slip angle of the rear tyres by lateral acceleration
  lever_forward,    // m, the GNSS antenna from the origin of the body
  lever_left,
  lever_up,
  gnss_delay,   // s, a fix is of so long before its stamp
  speed_scale,  // 1, the speed sensor (odometry or wheels) reports (1 + scale) times the speed
  lidar_scale,  // 1, a LiDAR's motion is (1 + scale) times the distance
  lidar_turn,   // rad/m, a LiDAR's motion turns too far by this about body z
  distance,     // m, travelled since the clone, as the speed sensor measures it
  clone_east,   // m, position at the start of the odometry interval
  clone_north,
  clone_up,
  clone_azimuth,  // rad, attitude at the start of the odometry interval
  clone_pitch,
  clone_roll,
  gnss_offset_east,  // 1, correlated part of a fix's error, in units of its own standard deviation
  gnss_offset_north,
  gnss_offset_up,
  chain_drift,  // rad, chained azimuth minus azimuth
  lane_offset,  // 1, offset to the right of the mapped line, in units of its own standard deviation
  count
};
}  // namespace index

using StateVector = Eigen::Matrix<double, index::count, 1>;
using StateMatrix = Eigen::Matrix<double, index::count, index::count>;

// This is the memory of the zero-velocity detector (inertial_update.h).
struct Stillness {
  double mean_force = 0.0;      // m/s^2, mean forward specific force of the last second
  double force_variance = 1.0;  // m^2/s^4
  double mean_left = 0.0;       // of the left specific force, and of the yaw rate, the same
  double left_variance = 1.0;
  double mean_rate = 0.0;
  double rate_variance = 1.0;
  double mean_roll_rate = 0.0;  // of the other rates of a full unit, the same
  double roll_rate_variance = 1.0;
  double mean_pitch_rate = 0.0;
  double pitch_rate_variance = 1.0;
  // These are the newest times at which odometry or the wheels showed a standing or a moving
  // vehicle.
  Time seen_standing{};
  Time seen_moving{};
  FixEvidence carried;  // that a vehicle that seems to stand moves,
  Time denied_until{};  // which is believed until then
};

template <class Archive>
void archive(Archive& ar, Stillness& s) {
  ar(s.mean_force, s.force_variance, s.mean_left, s.left_variance, s.mean_rate, s.rate_variance,
     s.mean_roll_rate, s.roll_rate_variance, s.mean_pitch_rate, s.pitch_rate_variance,
     s.seen_standing, s.seen_moving, s.carried, s.denied_until);
}

// This is a pose in the frame of odometry, which agrees with enu at the filter's start and then
// drifts: relative motions move it, and no absolute measurement does (REP 105).
struct OdomPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            // m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // turns body into odometry axes
};

template <class Archive>
void archive(Archive& ar, OdomPose& p) {
  ar(p.position, p.rotation);
}

// Holds everything the filter has estimated at one time; a copy is a snapshot.
struct FilterState {
  Time stamp{};
  StateVector x = StateVector::Zero();
  StateMatrix P = StateMatrix::Zero();
  Time clone_stamp{};
  OdomPose odom_at_clone;  // of the axes in which odometry is described
  Time start{};
  // These are the stamps of the newest measurement of each kind that this state includes (epoch 0:
  // none).
  Time imu_stamp{};
  Time odometry_stamp{};
  Time gnss_stamp{};
  Time wheel_stamp{};
  Time zero_velocity_stamp{};
  Time map_stamp{};
  Time speed_fixed{};  // newest stamp of an accurate velocity fix that was applied (held_by_fix)
  std::uint64_t odometry_applied = 0;
  std::uint64_t odometry_refused = 0;
  // These count the consecutive measurements of each kind that a gate refused.
  int gated_in_a_row = 0;
  int velocity_gated_in_a_row = 0;
  int wheel_gated_in_a_row = 0;
  int map_gated_in_a_row = 0;
  RefusedFixes refused_fixes;
  std::uint64_t recoveries = 0;
  std::uint64_t reinitializations = 0;
  // This azimuth is chained from odometry's rotations alone, at the time of the clone; only
  // `chain_odometry_azimuth` uses it.
  double chained_azimuth = 0.0;
  Stillness stillness;
  Duration imu_repeated{};    // how long inertial samples have only repeated one value
  double yaw_rate = 0.0;      // rad/s, measured by the gyro, of this time by its delay
  double acceleration = 0.0;  // m/s^2, of the speed, mean of the last moments; 0: not known
  Contradictions contradictions;
  WheelCheck wheel_check;
  FixBefore fix_before;
  FixEvidence front_doubt;   // that the vehicle's front is where its rear was assumed
  bool front_known = false;  // it has been faster than any reverses

  double ground_speed() const { return x[index::speed] / (1.0 + x[index::speed_scale]); }
  Attitude attitude() const { return {x[index::azimuth], x[index::pitch], x[index::roll]}; }
  Attitude clone_attitude() const {
    return {x[index::clone_azimuth], x[index::clone_pitch], x[index::clone_roll]};
  }
  // Returns how far the position has moved since the clone, m, enu.
  Eigen::Vector3d moved() const {
    return x.segment<3>(index::east) - x.segment<3>(index::clone_east);
  }
  double climb() const { return x[index::pitch] + x[index::climb_offset]; }  // rad, of travel
  Eigen::Vector3d gnss_lever() const { return x.segment<3>(index::lever_forward); }  // m, body
  OdometryMount mount() const { return {x[index::odometry_course], x[index::odometry_left]}; }
  // Returns (29) of METHOD.md: the pose in the frame of odometry, at the clone, and the motion
  // since. A correction by an absolute measurement moves the clone as well, so it cancels here.
  OdomPose odom() const;
  // The same of the axes in which odometry is described: they keep their pose when the filter
  // learns how they are mounted.
  OdomPose odom_of_described() const;
};

template <class Archive>
void archive(Archive& ar, FilterState& s) {
  ar(s.stamp, s.x, s.P, s.clone_stamp, s.odom_at_clone, s.start, s.imu_stamp, s.odometry_stamp,
     s.gnss_stamp, s.wheel_stamp, s.zero_velocity_stamp, s.map_stamp, s.speed_fixed,
     s.odometry_applied, s.odometry_refused, s.gated_in_a_row, s.refused_fixes,
     s.velocity_gated_in_a_row, s.wheel_gated_in_a_row, s.map_gated_in_a_row, s.recoveries,
     s.reinitializations, s.chained_azimuth, s.stillness, s.imu_repeated, s.yaw_rate,
     s.acceleration, s.contradictions, s.wheel_check, s.fix_before, s.front_doubt, s.front_known);
}

// Returns the unit vector in enu at an azimuth and an elevation (rad).
inline Eigen::Vector3d direction(double azimuth, double elevation) {
  const double c = std::cos(elevation);
  return {std::sin(azimuth) * c, std::cos(azimuth) * c, std::sin(elevation)};
}

// Adds a correction and keeps both azimuths in (-pi, pi].
inline void add_correction(StateVector& x, const StateVector& correction) {
  x += correction;
  x[index::azimuth] = wrap_angle(x[index::azimuth]);
  x[index::clone_azimuth] = wrap_angle(x[index::clone_azimuth]);
}

// Adds `sigma` squared to the variance of a state that the clone copied. The clone was just as
// wrong, so the motion since then stays as well known as it was.
inline void doubt_with_clone(FilterState& state, int original, double sigma) {
  const int copy = index::clone_east + (original < index::azimuth ? original - index::east
                                                                  : 3 + original - index::azimuth);
  for (const int i : {original, copy}) {
    for (const int j : {original, copy}) state.P(i, j) += sigma * sigma;
  }
}

// Adds a covariance (m^2, enu) to that of the position, and to the clone's in the same way.
inline void doubt_position_with_clone(FilterState& state, const Eigen::Matrix3d& covariance) {
  for (const int i : {index::east, index::clone_east}) {
    for (const int j : {index::east, index::clone_east}) state.P.block<3, 3>(i, j) += covariance;
  }
}

// The body's pose times the mounting's is that of the described axes. The positions are taken as
// differences, which lose no digits far from the origin.
inline OdomPose FilterState::odom_of_described() const {
  const Eigen::Isometry3d M = mount().T_body_described();
  const Eigen::Matrix3d R_clone = rotation_enu_body(clone_attitude());
  const Eigen::Matrix3d R_now = rotation_enu_body(attitude());
  const Eigen::Matrix3d to_odom =
      odom_at_clone.rotation.toRotationMatrix() * (R_clone * M.linear()).transpose();
  // (29) of METHOD.md
  return {odom_at_clone.position + to_odom * (moved() + (R_now - R_clone) * M.translation()),
          Eigen::Quaterniond(Eigen::Matrix3d(to_odom * R_now * M.linear())).normalized()};
}

inline OdomPose FilterState::odom() const {
  const OdomPose described = odom_of_described();
  const Eigen::Isometry3d back = mount().T_body_described().inverse();
  return {described.position + described.rotation * back.translation(),
          (described.rotation * Eigen::Quaterniond(back.linear())).normalized()};
}

// Copies the pose to the clone, fully correlated with the original, and restarts the distance from
// an exactly known zero.
inline void copy_to_clone(FilterState& state) {
  constexpr int pose[] = {index::east,    index::north, index::up,
                          index::azimuth, index::pitch, index::roll};
  for (int i = 0; i < 6; ++i) {
    const int to = index::clone_east + i;
    state.x[to] = state.x[pose[i]];
    state.P.row(to) = state.P.row(pose[i]);
  }
  for (int i = 0; i < 6; ++i) state.P.col(index::clone_east + i) = state.P.col(pose[i]);
  state.x[index::distance] = 0.0;
  state.P.row(index::distance).setZero();
  state.P.col(index::distance).setZero();
  state.clone_stamp = state.stamp;
}

// Takes the stochastic clone, from which the frame of odometry goes on.
inline void take_clone(FilterState& state) {
  state.odom_at_clone = state.odom_of_described();
  copy_to_clone(state);
}

// Starts the chained azimuth at the azimuth. The drift then equals the whole error of the azimuth.
inline void start_chain(FilterState& state) {
  using namespace index;
  state.chained_azimuth = state.x[azimuth];
  state.x[chain_drift] = 0.0;
  state.P.row(chain_drift) = -state.P.row(azimuth);
  state.P.col(chain_drift) = -state.P.col(azimuth);
  state.P(chain_drift, chain_drift) = state.P(azimuth, azimuth);
}

// Starts the clone and the chained azimuth at a state that was set to new values. The frame of
// odometry goes on from `odom`, the pose of the described axes.
inline void start_clone(FilterState& state, const OdomPose& odom) {
  copy_to_clone(state);
  state.odom_at_clone = odom;
  start_chain(state);
}

// Does the same for a first state, at which the frame of odometry agrees with enu.
inline void start_clone(FilterState& state) {
  const Eigen::Matrix3d R_enu_body = rotation_enu_body(state.attitude());
  const Eigen::Isometry3d M = state.mount().T_body_described();
  start_clone(state, {state.x.segment<3>(index::east) + R_enu_body * M.translation(),
                      Eigen::Quaterniond(Eigen::Matrix3d(R_enu_body * M.linear()))});
}

// Returns in its columns how the body turns, as a rotation vector in enu, per radian of azimuth,
// pitch and roll: R(a + d) = exp(E d) R(a) to first order.
inline Eigen::Matrix3d attitude_rate_axes(const Attitude& a) {
  const double sA = std::sin(a.azimuth), cA = std::cos(a.azimuth);
  const double sp = std::sin(a.pitch), cp = std::cos(a.pitch);
  Eigen::Matrix3d axes;
  axes.col(0) << 0.0, 0.0, -1.0;        // clockwise seen from above
  axes.col(1) << cA, -sA, 0.0;          // about the horizontal axis to the right
  axes.col(2) << sA * cp, cA * cp, sp;  // about the forward axis
  return axes;
}

// Returns the derivative of R(a) v by azimuth, pitch and roll, where `v_enu` is R(a) v.
inline Eigen::Matrix3d turned_by_attitude(const Attitude& a, const Eigen::Vector3d& v_enu) {
  const Eigen::Matrix3d axes = attitude_rate_axes(a);
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) J.col(i) = axes.col(i).cross(v_enu);
  return J;
}

}  // namespace maploop::fusion
