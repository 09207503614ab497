#include "estimators/fusion/odometry_update.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimators/fusion/gnss_update.h"

namespace maploop::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Returns the rotation vector of a unit quaternion with an angle of at most pi.
Vector3d rotation_vector(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, q.w());
  return (sine < 1e-9 ? 2.0 : angle / sine) * q.vec();
}

// Returns when position and speed were last corrected by any aid, or the start.
Time aided_at(const FilterState& state, const FusionParameters& p) {
  return std::max({state.odometry_stamp, state.wheel_stamp, state.zero_velocity_stamp,
                   p.use_gnss ? state.gnss_stamp : Time{}, state.start});
}

// Inflates the covariance for a speed error, which also moved the position since the last aid.
void doubt_speed(FilterState& state, const RelativeMotion& motion, const FusionParameters& p) {
  using namespace index;
  StateVector error = StateVector::Zero();
  error.segment<3>(east) =
      to_seconds(motion.stamp - aided_at(state, p)) * rotation_enu_body(state.attitude()).col(0);
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
  const double contradiction = std::abs(rotation_innovation(state, motion, p).residual.z());
  const double before = std::max(0.0, alone / interval) * contradiction;
  const Vector3d aside = -0.5 * to_seconds(motion.stamp - aided_at(state, p)) * state.x[speed] *
                         rotation_enu_body(state.attitude()).col(1);
  const auto add = [&](StateVector error, double sigma) {
    error.segment<3>(east) = aside;
    error[azimuth] = 1.0;
    state.P += sigma * sigma * error * error.transpose();  // (26) of METHOD.md
  };
  add(StateVector::Zero(), p.recovery_rotation_sigma);
  add(StateVector::Unit(clone_azimuth), before);

  state.P(pitch, pitch) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(roll, roll) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(gyro_bias, gyro_bias) += p.gyro_bias_sigma * p.gyro_bias_sigma;
}

// Keeps only the rotation about the horizontal axes.
Innovation<2> tilt_innovation(const FilterState& state, const RelativeMotion& motion,
                              const FusionParameters& parameters) {
  const Innovation<3> all = rotation_innovation(state, motion, parameters);
  Innovation<2> innovation;
  innovation.residual = all.residual.head<2>();
  innovation.H = all.H.topRows<2>();
  innovation.R = all.R.topLeftCorner<2, 2>();
  return innovation;
}

// Adds the motion's turning to the chained azimuth.
void chain(FilterState& state, const RelativeMotion& motion) {
  Attitude start = state.clone_attitude();
  start.azimuth = state.chained_azimuth;
  state.chained_azimuth =
      attitude_from_rotation(rotation_enu_body(start) * motion.rotation.toRotationMatrix()).azimuth;
  state.P(index::chain_drift, index::chain_drift) += motion.covariance(5, 5);
}

Outcome correct_turning(FilterState& state, const RelativeMotion& motion,
                        const FusionParameters& p) {
  if (p.use_odometry_azimuth && !p.chain_odometry_azimuth) {
    return apply_gated(state, rotation_innovation(state, motion, p), p.rotation_gate,
                       Reason::rotation_gate);
  }
  Outcome outcome =
      apply_gated(state, tilt_innovation(state, motion, p), p.rotation_gate, Reason::rotation_gate);
  if (outcome.refused() || !p.use_odometry_azimuth) return outcome;
  chain(state, motion);
  return apply_gated(state, chained_azimuth_innovation(state, p), p.speed_gate,
                     Reason::rotation_gate);
}

// Applies all corrections or leaves the state unchanged.
Outcome correct(FilterState& state, const RelativeMotion& motion, const FusionParameters& p) {
  const StateVector x = state.x;
  const StateMatrix P = state.P;
  const double chained = state.chained_azimuth;
  const Innovation<3> turning = rotation_innovation(state, motion, p);
  const double turning_variance = turning.covariance(P)(2, 2);
  Outcome outcome;
  if (p.use_odometry_speed) {
    outcome =
        apply_gated(state, distance_innovation(state, motion, p), p.speed_gate, Reason::speed_gate);
  }
  if (!outcome.refused()) outcome = correct_turning(state, motion, p);
  if (!outcome.refused() && p.use_odometry_speed) {
    // A gated climb is skipped without refusing the motion.
    apply_gated(state, climb_innovation(state, motion, p), p.speed_gate, Reason::speed_gate);
  }
  if (!outcome.refused() && (std::abs(state.x[index::pitch]) > p.max_tilt ||
                             std::abs(state.x[index::roll]) > p.max_tilt)) {
    outcome = refused(Reason::implausible_tilt);
  }
  if (outcome.refused()) {
    state.x = x;
    state.P = P;
    state.chained_azimuth = chained;
  } else {
    state.imu_delay.add(state.yaw_rate - state.clone_yaw_rate, turning.residual.z(),
                        turning_variance);
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

void turn_round(FilterState& state) {
  using namespace index;
  StateVector& x = state.x;
  x[azimuth] = wrap_angle(x[azimuth] + std::numbers::pi);
  x[clone_azimuth] = wrap_angle(x[clone_azimuth] + std::numbers::pi);
  x[pitch] = -x[pitch] - 2.0 * x[climb_offset];
  x[clone_pitch] = -x[clone_pitch] - 2.0 * x[climb_offset];
  state.chained_azimuth = wrap_angle(state.chained_azimuth + std::numbers::pi);
  for (const int i : {speed, distance, roll, clone_roll}) x[i] = -x[i];
  for (const int i : {speed, distance, pitch, clone_pitch, roll, clone_roll}) {
    state.P.row(i) *= -1.0;
    state.P.col(i) *= -1.0;
  }
}

// Ranges and disparities differ in scale, and wheels do not affect the scale of ranges.
bool by_ranges(const RelativeMotion& motion) {
  return motion.source != OdometrySource::visual;
}

// The gain is a motion's measured length per distance; `by_state` is its derivative.
struct Gain {
  double value;
  StateVector by_state = StateVector::Zero();
};

Gain gain_of(const FilterState& state, const RelativeMotion& motion) {
  using namespace index;
  if (!by_ranges(motion)) return {1.0};
  const double to_ground = 1.0 / (1.0 + state.x[speed_scale]);
  Gain gain{to_ground * (1.0 + state.x[lidar_scale])};
  gain.by_state[speed_scale] = -to_ground * gain.value;
  gain.by_state[lidar_scale] = to_ground;
  return gain;
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
  outcome = correct(state, motion, p);
  if (outcome.refused()) {
    state = before;
  } else {
    ++state.recoveries;
  }
  return outcome;
}

}  // namespace

Arc arc(const RelativeMotion& motion) {
  const Vector3d turn = rotation_vector(motion.rotation);
  const double half = 0.5 * turn.norm();
  Matrix3d to_arc = Matrix3d::Identity();
  if (half > 1e-9) {
    // (12) of METHOD.md
    to_arc = half / std::sin(half) * Eigen::AngleAxisd(-half, turn.normalized()).toRotationMatrix();
  }
  return {to_arc * motion.translation,
          to_arc * motion.covariance.topLeftCorner<3, 3>() * to_arc.transpose()};
}

Innovation<1> distance_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters) {
  const Arc travelled = arc(motion);
  const double floor = parameters.min_speed_sigma * to_seconds(motion.stamp - motion.from);
  const Gain gain = gain_of(state, motion);
  Innovation<1> innovation;
  // (13) of METHOD.md
  innovation.residual << travelled.displacement.x() - gain.value * state.x[index::distance];
  innovation.H = state.x[index::distance] * gain.by_state.transpose();
  innovation.H[index::distance] = gain.value;
  innovation.R << travelled.covariance(0, 0) + floor * floor;
  return innovation;
}

Innovation<1> climb_innovation(const FilterState& state, const RelativeMotion& motion,
                               const FusionParameters& parameters) {
  const Arc travelled = arc(motion);
  const double distance = state.x[index::distance];
  const Gain gain = gain_of(state, motion);
  const double offset = state.x[index::climb_offset];
  const double heave = parameters.climb_noise * distance;
  const double floor = parameters.min_speed_sigma * to_seconds(motion.stamp - motion.from);
  Innovation<1> innovation;
  // (14) of METHOD.md
  innovation.residual << travelled.displacement.z() - gain.value * distance * offset;
  innovation.H = distance * offset * gain.by_state.transpose();
  innovation.H[index::climb_offset] = gain.value * distance;
  innovation.H[index::distance] = gain.value * offset;
  innovation.R << travelled.covariance(2, 2) + heave * heave + floor * floor;
  return innovation;
}

Innovation<3> rotation_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters) {
  const Attitude now = state.attitude();
  const Attitude clone = state.clone_attitude();
  const Matrix3d R_clone_enu = rotation_enu_body(clone).transpose();
  const Matrix3d predicted = R_clone_enu * rotation_enu_body(now);
  const double floor = parameters.min_rotation_sigma;

  Innovation<3> innovation;
  // (15) of METHOD.md
  innovation.residual = rotation_vector(
      Eigen::Quaterniond(Matrix3d(motion.rotation.toRotationMatrix() * predicted.transpose())));
  innovation.H.setZero();
  innovation.H.middleCols<3>(index::azimuth) = R_clone_enu * attitude_rate_axes(now);
  innovation.H.middleCols<3>(index::clone_azimuth) = -R_clone_enu * attitude_rate_axes(clone);
  if (by_ranges(motion)) {
    const double way = arc(motion).displacement.x();
    innovation.residual.z() -= way * state.x[index::lidar_turn];
    innovation.H(2, index::lidar_turn) = way;
  }
  innovation.R = motion.covariance.bottomRightCorner<3, 3>() + floor * floor * Matrix3d::Identity();
  return innovation;
}

Innovation<1> chained_azimuth_innovation(const FilterState& state, const FusionParameters& p) {
  using namespace index;
  Innovation<1> innovation;
  // (16) of METHOD.md
  innovation.residual << wrap_angle(state.chained_azimuth - state.x[azimuth] -
                                    state.x[chain_drift]);
  innovation.H.setZero();
  innovation.H[azimuth] = 1.0;
  innovation.H[chain_drift] = 1.0;
  innovation.R << p.chained_azimuth_sigma * p.chained_azimuth_sigma;
  return innovation;
}

Outcome apply_odometry(FilterState& state, const RelativeMotion& motion,
                       const FusionParameters& parameters) {
  Outcome outcome;
  if (motion.status != OdometryStatus::ok) {
    outcome = refused(Reason::odometry_not_ok);
  } else if (state.clone_stamp != motion.from) {
    outcome = refused(Reason::interval_unknown);
  } else {
    outcome = correct(state, motion, parameters);
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
