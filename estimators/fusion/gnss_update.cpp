#include "estimators/fusion/gnss_update.h"

#include <algorithm>
#include <cmath>

#include "estimators/fusion/fix_error.h"
#include "estimators/fusion/follow_innovation.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/swing.h"

namespace maploop::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void inflate_position(FilterState& state, const FusionParameters& p) {
  using namespace index;
  for (int i = east; i <= up; ++i) doubt_with_clone(state, i, p.gnss_recovery_sigma);
  doubt_with_clone(state, azimuth, p.recovery_rotation_sigma);
}

// Restarts from the position, speed and attitude of the fix; keeps the sensor errors estimated so
// far.
void restart_from(FilterState& state, GnssFix fix, const LocalFrame& frame,
                  const FusionParameters& p) {
  using namespace index;
  fix.velocity_stamp = fix.stamp;
  const StateMatrix known = state.P;
  const StateVector x = state.x;
  const OdomPose odom = state.odom_of_described();
  FusionParameters learnt = p;
  learnt.climb_offset = x[climb_offset];
  learnt.rear_axle_distance = x[axle_distance];
  learnt.rear_slip = x[rear_slip];
  const FilterState fresh = initial_state(fix, frame, learnt, state.yaw_rate - x[gyro_bias]);
  state.x = fresh.x;
  state.P = fresh.P;
  for (const int i : {gyro_bias, forward_bias, left_bias, climb_offset, imu_delay, odometry_course,
                      odometry_left, axle_distance, rear_slip, lidar_scale, lidar_turn}) {
    state.x[i] = x[i];
    state.P.row(i).setZero();
    state.P.col(i).setZero();
    state.P(i, i) = known(i, i);
  }
  // The scale's variance is that of a new start, but its estimate is kept and applied to the speed.
  state.x[speed] *= 1.0 + x[speed_scale];
  state.x[speed_scale] = x[speed_scale];
  state.front_known = false;
  start_clone(state, odom);
  ++state.reinitializations;
}

// This is the position that a fix adds to what the filter knows: of a carried fix, its increment.
struct Measured {
  Vector3d position;  // m, enu
  FixError error;
};

Measured measured_by(const GnssFix& fix, const LocalFrame& frame, const FusionParameters& p) {
  const Vector3d position = frame.to_enu(fix.position);
  if (!fix.increment) return {position, split_error(fix.position_covariance, p)};
  return {position + fix.increment->position,
          {Matrix3d::Zero(), fix.increment->position_covariance}};
}

const Vector3d& velocity_of(const GnssFix& fix) {
  return fix.increment ? fix.increment->velocity_enu : fix.velocity_enu;
}

const Matrix3d& velocity_covariance_of(const GnssFix& fix) {
  return fix.increment ? fix.increment->velocity_covariance : fix.velocity_covariance;
}

// This is a velocity (m/s) or an acceleration (m/s^2) over ground, enu, with its derivatives by the
// state.
struct Motion {
  Vector3d value;
  Eigen::Matrix<double, 3, index::count> by_state = Eigen::Matrix<double, 3, index::count>::Zero();
};

// Takes a speed or its change by time, along the travel.
Motion along_travel(const FilterState& state, double value) {
  using namespace index;
  const double sA = std::sin(state.x[azimuth]), cA = std::cos(state.x[azimuth]);
  const double sc = std::sin(state.climb()), cc = std::cos(state.climb());
  Motion motion{value * Vector3d(sA * cc, cA * cc, sc)};
  motion.by_state.col(azimuth) = value * Vector3d(cA * cc, -sA * cc, 0.0);
  motion.by_state.col(climb_offset) = value * Vector3d(-sA * sc, -cA * sc, cc);
  motion.by_state.col(pitch) = motion.by_state.col(climb_offset);
  return motion;
}

// Adds the derivatives of the speed over ground times `factor`, along `axis`.
void add_speed_derivatives(const FilterState& state, double factor, const Vector3d& axis,
                           Motion& motion) {
  const double to_ground = 1.0 / (1.0 + state.x[index::speed_scale]);
  motion.by_state.col(index::speed) = to_ground * factor * axis;
  motion.by_state.col(index::speed_scale) = -state.ground_speed() * to_ground * factor * axis;
}

Motion velocity_of(const FilterState& state) {
  Motion velocity = along_travel(state, state.ground_speed());
  add_speed_derivatives(state, 1.0, direction(state.x[index::azimuth], state.climb()), velocity);
  return velocity;
}

// Takes the rate of turning to the left, rad/s.
Motion acceleration_of(const FilterState& state, double rate) {
  const double sA = std::sin(state.x[index::azimuth]), cA = std::cos(state.x[index::azimuth]);
  const double ground = state.ground_speed();
  const Vector3d left(-cA, sA, 0.0);
  Motion acceleration = along_travel(state, state.acceleration);
  acceleration.value += ground * rate * left;
  acceleration.by_state.col(index::azimuth) += ground * rate * Vector3d(sA, cA, 0.0);
  acceleration.by_state.col(index::gyro_bias) = -ground * left;
  add_speed_derivatives(state, rate, left, acceleration);
  return acceleration;
}

// A receiver that is carried measures at its stamps. Without inertial data, nothing tells how the
// velocity changes over the delay, and a vehicle that was in reverse contradicts its fixes anyway.
bool may_be_late(const FilterState& state, const GnssFix& fix, const FusionParameters& p) {
  return !fix.increment && p.gnss_delay_sigma > 0.0 && state.front_known &&
         state.stamp - state.imu_stamp <= from_seconds(p.imu_hold);
}

// Makes an innovation that of the time at which the fix was measured; `change` is what it measures
// by time.
void take_earlier(Innovation<3>& innovation, const FilterState& state, const Motion& change) {
  const double delay = state.x[index::gnss_delay];  // (43) of METHOD.md
  innovation.residual += delay * change.value;
  innovation.H -= delay * change.by_state;
  innovation.H.col(index::gnss_delay) -= change.value;
}

// Returns whether a velocity contradicts the state by its length alone: then the wheels slip, or
// odometry is wrong, and the azimuth is right.
bool contradicts_speed_alone(const FilterState& state, const Innovation<3>& innovation,
                             double gate) {
  const double climb = state.climb(), azimuth = state.x[index::azimuth];
  Matrix3d axes;  // of the travel: forward, left, up
  axes.row(0) = direction(azimuth, climb);
  axes.row(1) << -std::cos(azimuth), std::sin(azimuth), 0.0;
  axes.row(2) = axes.row(0).cross(axes.row(1));
  Innovation<3> turned;
  turned.residual = axes * innovation.residual;
  turned.H = axes * innovation.H;
  turned.R = axes * innovation.R * axes.transpose();
  return turned.part<2>(1).nis(state.P) <= gate;
}

}  // namespace

Innovation<3> position_innovation(const FilterState& state, const GnssFix& fix,
                                  const LocalFrame& frame, const FusionParameters& p) {
  using namespace index;
  const Vector3d arm = rotation_enu_body(state.attitude()) * state.gnss_lever();
  const auto [position, error] = measured_by(fix, frame, p);
  Innovation<3> innovation;
  // (18) of METHOD.md
  innovation.residual = position - state.x.segment<3>(east) - arm -
                        error.lasting * state.x.segment<3>(gnss_offset_east);
  innovation.H.middleCols<3>(east).setIdentity();
  innovation.H.middleCols<3>(azimuth) = turned_by_attitude(state.attitude(), arm);
  innovation.H.middleCols<3>(lever_forward) = rotation_enu_body(state.attitude());
  innovation.H.middleCols<3>(gnss_offset_east) = error.lasting;
  innovation.R = error.fresh;
  innovation.R.diagonal().array() += p.min_position_sigma * p.min_position_sigma;
  if (may_be_late(state, fix, p)) take_earlier(innovation, state, velocity_of(state));
  return innovation;
}

Innovation<3> velocity_innovation(const FilterState& state, const GnssFix& fix, double yaw_rate,
                                  const FusionParameters& p) {
  using namespace index;
  const StateVector& x = state.x;
  // The antenna rotates about the point that moves along the azimuth.
  const Vector3d arm = state.gnss_lever() + Vector3d(swing_arm(x), 0.0, 0.0);
  const Matrix3d R = rotation_enu_body(state.attitude());
  const double rate = yaw_rate - x[gyro_bias];
  const Vector3d swing = R * Vector3d(0.0, 0.0, rate).cross(arm);
  const Motion velocity = velocity_of(state);

  Innovation<3> innovation;
  innovation.residual = velocity_of(fix) - velocity.value - swing;  // (19) of METHOD.md
  innovation.H = velocity.by_state;
  innovation.H.middleCols<3>(azimuth) += turned_by_attitude(state.attitude(), swing);
  innovation.H.col(gyro_bias) = -(R * Vector3d::UnitZ().cross(arm));
  add_swing_derivatives(x, rate * R.col(1), innovation.H);
  innovation.H.col(lever_forward) = rate * R.col(1);
  innovation.H.col(lever_left) = -rate * R.col(0);
  const Vector3d travel = direction(x[azimuth], state.climb());
  const double slip = p.slip_sigma * state.ground_speed();
  innovation.R = velocity_covariance_of(fix) +
                 slip * slip * (Matrix3d::Identity() - travel * travel.transpose());
  innovation.R.diagonal().array() += p.min_velocity_sigma * p.min_velocity_sigma;
  if (may_be_late(state, fix, p)) take_earlier(innovation, state, acceleration_of(state, rate));
  return innovation;
}

Outcome apply_gnss_position(FilterState& state, const GnssFix& fix, const LocalFrame& frame,
                            const FusionParameters& p) {
  LastingError& witness = state.contradictions.of(Witness::fix_position);
  const auto correct = [&](const Innovation<3>& innovation) {
    return apply_gated(state, innovation, p.gnss_position_gate, Reason::position_gate, p.max_tilt,
                       witness.excess(2, p.doubt_scatter));
  };
  if (fix.increment) doubt_position_with_clone(state, fix.increment->growth);
  const Innovation<3> innovation = position_innovation(state, fix, frame, p);
  follow(state, Witness::fix_position, innovation, p);
  Outcome outcome = correct(innovation);
  RefusedFixes& row = state.refused_fixes;
  if (outcome.refused()) {
    const double variance = fix.position_covariance.diagonal().head<2>().maxCoeff() +
                            p.min_position_sigma * p.min_position_sigma;
    row.add(fix.stamp, frame.to_enu(fix.position).head<2>(), variance,
            state.odom().position.head<2>(), std::max(state.odometry_stamp, state.wheel_stamp),
            p.gnss_position_gate);
    if (row.count == p.gnss_recover_after) {
      inflate_position(state, p);
      witness = {};
      ++state.recoveries;
      outcome = correct(position_innovation(state, fix.alone(), frame, p));
    } else if (row.count >= 2 * p.gnss_recover_after && check_fix(fix, p) == Reason::none) {
      restart_from(state, fix, frame, p);
      witness = {};
      outcome = {};
    }
  }
  if (!outcome.refused()) {
    row = {};
    state.gnss_stamp = fix.stamp;
  }
  return outcome;
}

Outcome apply_gnss_velocity(FilterState& state, const GnssFix& fix, double yaw_rate,
                            const FusionParameters& p) {
  const auto correct = [&](const Innovation<3>& innovation) {
    return apply_gated(state, innovation, p.gnss_velocity_gate, Reason::velocity_gate, p.max_tilt);
  };
  const Innovation<3> innovation = velocity_innovation(state, fix, yaw_rate, p);
  follow(state, Witness::fix_velocity, innovation, p);
  Outcome outcome = correct(innovation);
  const bool slips =
      outcome.refused() && contradicts_speed_alone(state, innovation, p.gnss_velocity_gate);
  if (outcome.refused() && !state.refused_fixes.astray &&
      ++state.velocity_gated_in_a_row ==
          (slips ? p.gnss_recover_speed_after : p.gnss_recover_after)) {
    if (slips) {
      state.P(index::speed, index::speed) += p.recovery_speed_sigma * p.recovery_speed_sigma;
    } else {
      doubt_with_clone(state, index::azimuth, p.gnss_recovery_course_sigma);
    }
    ++state.recoveries;
    outcome = correct(velocity_innovation(state, fix, yaw_rate, p));
  }
  if (!outcome.refused()) state.velocity_gated_in_a_row = 0;
  const double sigma = std::sqrt(velocity_covariance_of(fix).diagonal().head<2>().maxCoeff());
  if (!outcome.refused() && sigma <= 0.2 * p.recovery_speed_sigma) {
    state.speed_fixed = fix.velocity_stamp;
  }
  return outcome;
}

bool held_by_fix(const FilterState& state, const FusionParameters& p) {
  return state.stamp - state.speed_fixed <= from_seconds(p.fix_hold);
}

}  // namespace maploop::fusion
