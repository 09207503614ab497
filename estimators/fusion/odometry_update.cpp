#include "estimators/fusion/odometry_update.h"

#include <algorithm>
#include <cmath>

#include "estimators/fusion/follow_innovation.h"
#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/odometry_innovation.h"
#include "estimators/fusion/turn_round.h"

namespace maploop::fusion {
namespace {

using Eigen::Vector3d;

// Returns when position and speed were last corrected by any aid, or the start.
Time aided_at(const FilterState& state, const FusionParameters& p) {
  return std::max({state.odometry_stamp, state.wheel_stamp, state.zero_velocity_stamp,
                   p.use_gnss ? state.gnss_stamp : Time{}, state.start});
}

// Inflates the covariance for a speed error, which also moved the position since the last aid.
void doubt_speed(FilterState& state, const RelativeMotion& motion, const FusionParameters& p) {
  using namespace index;
  StateVector error = StateVector::Zero();
  const Vector3d ahead = rotation_enu_body(state.attitude()).col(0);
  const Time aided = aided_at(state, p);
  error.segment<3>(east) = to_seconds(motion.stamp - aided) * ahead;
  error.segment<3>(clone_east) = std::max(0.0, to_seconds(motion.from - aided)) * ahead;
  error[speed] = 1.0;
  error[distance] = to_seconds(motion.stamp - motion.from);
  error *= p.recovery_speed_sigma;
  state.P += error * error.transpose();  // (26) of METHOD.md
}

// Inflates the covariance for a rotation error over the interval. The azimuth may also have been
// wrong in each interval since the last applied odometry, by as much as this motion contradicts it.
// That sum is equal at both ends of the interval, so odometry cannot reduce it again.
void doubt_rotation(FilterState& state, const RelativeMotion& motion, const FusionParameters& p) {
  using namespace index;
  const double interval = to_seconds(motion.stamp - motion.from);
  const double alone = to_seconds(motion.from - std::max(state.odometry_stamp, state.start));
  const double contradiction = std::abs(motion_innovation(state, motion, p).residual[5]);
  const double before = std::max(0.0, alone / interval) * contradiction;
  const Vector3d aside = -0.5 * state.x[speed] * rotation_enu_body(state.attitude()).col(1);
  // An azimuth error that grows from zero moves the position aside by half of it, over this time.
  const double since_aid = std::max(interval, to_seconds(motion.stamp - aided_at(state, p)));
  const double until_clone = since_aid - interval;
  const auto add = [&](StateVector error, double time, double sigma) {
    error.segment<3>(east) = time * aside;
    error[azimuth] = 1.0;
    state.P += sigma * sigma * error * error.transpose();  // (26) of METHOD.md
  };
  add(StateVector::Zero(), interval, p.recovery_rotation_sigma);
  StateVector at_clone = StateVector::Unit(clone_azimuth);
  at_clone.segment<3>(clone_east) = until_clone * until_clone / since_aid * aside;
  add(at_clone, since_aid, before);

  state.P(pitch, pitch) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(roll, roll) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(gyro_bias, gyro_bias) += p.gyro_bias_sigma * p.gyro_bias_sigma;
}

// Adds the motion's turning to the chained azimuth.
void chain(FilterState& state, const RelativeMotion& motion) {
  Attitude start = state.clone_attitude();
  start.azimuth = state.chained_azimuth;
  state.chained_azimuth =
      attitude_from_rotation(rotation_enu_body(start) * motion.rotation.toRotationMatrix()).azimuth;
  state.P(index::chain_drift, index::chain_drift) += motion.covariance(5, 5);
}

// Returns whether the state agrees with `n` rows of the motion.
template <int n>
bool agrees(const FilterState& state, const Innovation<6>& all, int first, double gate) {
  return all.part<n>(first).nis(state.P) <= gate;  // (10) of METHOD.md
}

// Corrects by those rows that the configuration uses, or refuses the motion.
Outcome correct_pose(FilterState& state, Innovation<6> rows, const FusionParameters& p) {
  if (p.use_odometry_speed) {
    if (!agrees<1>(state, rows, 0, p.speed_gate)) return refused(Reason::speed_gate);
    // Where the vehicle slips or heaves, the rest of the motion is still right.
    if (!agrees<2>(state, rows, 1, p.sideways_gate)) rows.leave_out(1, 2);
  } else {
    rows.leave_out(0, 3);
  }
  const bool turning = p.use_odometry_azimuth && !p.chain_odometry_azimuth;
  if (!(turning ? agrees<3>(state, rows, 3, p.rotation_gate)
                : agrees<2>(state, rows, 3, p.rotation_gate))) {
    return refused(Reason::rotation_gate);
  }
  if (!turning) rows.leave_out(5, 1);
  const bool done = joseph_update(state.x, state.P, rows, {}, p.max_tilt);
  return done ? Outcome{} : refused(Reason::implausible_tilt);
}

// Applies all corrections or leaves the state unchanged.
Outcome correct(FilterState& state, const RelativeMotion& motion, const Innovation<6>& rows,
                const FusionParameters& p) {
  const StateVector x = state.x;
  const StateMatrix P = state.P;
  const double chained = state.chained_azimuth;
  Outcome outcome = correct_pose(state, rows, p);
  if (!outcome.refused() && p.use_odometry_azimuth && p.chain_odometry_azimuth) {
    chain(state, motion);
    outcome = apply_gated(state, chained_azimuth_innovation(state, p), p.speed_gate,
                          Reason::rotation_gate, p.max_tilt);
  }
  if (outcome.refused()) {
    state.x = x;
    state.P = P;
    state.chained_azimuth = chained;
  }
  return outcome;
}

// A start from a course assumes that the vehicle drives forward. If odometry shows the same speed
// in the opposite direction, the vehicle was in reverse: its front points to where its rear was
// assumed, and its path stays the same.
bool drives_backward(const FilterState& state, const RelativeMotion& motion,
                     const FusionParameters& p) {
  if (!p.use_odometry_speed) return false;
  const double expected = state.x[index::distance];
  const double seen = arc(motion).displacement.x();
  constexpr double alike = 0.3;
  return expected * seen < 0.0 && std::abs(seen + expected) < alike * std::abs(seen - expected) &&
         std::abs(seen) > p.min_course_speed * to_seconds(motion.stamp - motion.from);
}

// Corrects with an inflated covariance. If even this is refused, the state stays as it was.
Outcome recover(FilterState& state, const RelativeMotion& motion, Outcome outcome,
                const FusionParameters& p) {
  const FilterState before = state;
  const bool backward = drives_backward(state, motion, p);
  if (backward) turn_round(state);
  if (!held_by_fix(state, p)) {
    doubt_speed(state, motion, p);
  } else if (outcome.reason == Reason::speed_gate && !backward) {
    return outcome;
  }
  doubt_rotation(state, motion, p);
  outcome = correct(state, motion, motion_innovation(state, motion, p), p);
  if (outcome.refused()) {
    state = before;
  } else {
    ++state.recoveries;
  }
  return outcome;
}

}  // namespace

Outcome apply_odometry(FilterState& state, const RelativeMotion& motion,
                       const FusionParameters& parameters) {
  Outcome outcome;
  if (motion.status != OdometryStatus::ok) {
    outcome = refused(Reason::odometry_not_ok);
  } else if (state.clone_stamp != motion.from) {
    outcome = refused(Reason::interval_unknown);
  } else {
    const Innovation<6> rows = motion_innovation(state, motion, parameters);
    follow(state, Witness::motion_length, rows.part<1>(0), parameters);
    follow(state, Witness::motion_turn, rows.part<1>(5), parameters);
    outcome = correct(state, motion, rows, parameters);
    if (!outcome.refused()) {
      state.gated_in_a_row = 0;
    } else if (++state.gated_in_a_row >= parameters.recover_after) {
      outcome = recover(state, motion, outcome, parameters);
    }
  }
  if (outcome.refused()) {
    // The chain misses the rotation of a refused motion, so it restarts.
    if (parameters.chain_odometry_azimuth) start_chain(state);
    ++state.odometry_refused;
  } else {
    ++state.odometry_applied;
    state.odometry_stamp = motion.stamp;
  }
  take_clone(state);
  return outcome;
}

}  // namespace maploop::fusion
