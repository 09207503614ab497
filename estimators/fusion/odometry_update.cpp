#include "estimators/fusion/odometry_update.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace maploop::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Rotation vector of a unit quaternion, the short way round.
Vector3d rotation_vector(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, q.w());
  return (sine < 1e-9 ? 2.0 : angle / sine) * q.vec();
}

// The prediction may have been wrong since the last odometry that was applied: in speed, hence in
// distance and position, and in the rotation over the interval.
void inflate(FilterState& state, const RelativeMotion& motion, const FusionParameters& p) {
  using namespace index;
  const Time since = std::max(state.odometry_stamp, state.start);
  const double unaided = to_seconds(motion.stamp - since);
  const Matrix3d R = rotation_enu_body(state.attitude());

  StateVector speed_error = StateVector::Zero();
  speed_error.segment<3>(east) = unaided * R.col(0);
  speed_error[speed] = 1.0;
  speed_error[distance] = to_seconds(motion.stamp - motion.from);
  speed_error *= p.recovery_speed_sigma;
  state.P += speed_error * speed_error.transpose();

  StateVector azimuth_error = StateVector::Zero();
  azimuth_error.segment<3>(east) = -0.5 * unaided * state.x[speed] * R.col(1);
  azimuth_error[azimuth] = 1.0;
  azimuth_error *= p.recovery_rotation_sigma;
  state.P += azimuth_error * azimuth_error.transpose();

  state.P(pitch, pitch) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(roll, roll) += p.recovery_rotation_sigma * p.recovery_rotation_sigma;
  state.P(gyro_bias, gyro_bias) += p.gyro_bias_sigma * p.gyro_bias_sigma;
}

Outcome correct(FilterState& state, const RelativeMotion& motion,
                const FusionParameters& parameters) {
  const Innovation<1> distance = distance_innovation(state, motion, parameters);
  if (!(distance.nis(state.P) <= parameters.speed_gate)) return refused(Reason::speed_gate);
  if (!(rotation_innovation(state, motion, parameters).nis(state.P) <= parameters.rotation_gate)) {
    return refused(Reason::rotation_gate);
  }
  StateVector x = state.x;
  StateMatrix P = state.P;
  joseph_update(state.x, state.P, distance);
  joseph_update(state.x, state.P, rotation_innovation(state, motion, parameters));
  const Innovation<1> climb = climb_innovation(state, motion, parameters);
  if (climb.nis(state.P) <= parameters.speed_gate) joseph_update(state.x, state.P, climb);
  if (std::abs(state.x[index::pitch]) <= parameters.max_tilt &&
      std::abs(state.x[index::roll]) <= parameters.max_tilt) {
    return {};
  }
  state.x = x;
  state.P = P;
  return refused(Reason::implausible_tilt);
}

}  // namespace

Arc arc(const RelativeMotion& motion) {
  const Vector3d turn = rotation_vector(motion.rotation);
  const double half = 0.5 * turn.norm();
  Matrix3d to_arc = Matrix3d::Identity();
  if (half > 1e-9) {
    to_arc = half / std::sin(half) * Eigen::AngleAxisd(-half, turn.normalized()).toRotationMatrix();
  }
  return {to_arc * motion.translation,
          to_arc * motion.covariance.topLeftCorner<3, 3>() * to_arc.transpose()};
}

Innovation<1> distance_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters) {
  const Arc travelled = arc(motion);
  const double floor = parameters.min_speed_sigma * to_seconds(motion.stamp - motion.from);
  const double gain = 1.0 + state.x[index::odometry_scale];
  Innovation<1> innovation;
  innovation.residual << travelled.displacement.x() - gain * state.x[index::distance];
  innovation.H.setZero();
  innovation.H[index::distance] = gain;
  innovation.H[index::odometry_scale] = state.x[index::distance];
  innovation.R << travelled.covariance(0, 0) + floor * floor;
  return innovation;
}

Innovation<1> climb_innovation(const FilterState& state, const RelativeMotion& motion,
                               const FusionParameters& parameters) {
  const Arc travelled = arc(motion);
  const double distance = state.x[index::distance];
  const double gain = 1.0 + state.x[index::odometry_scale];
  const double offset = state.x[index::climb_offset];
  const double heave = parameters.climb_noise * distance;
  const double floor = parameters.min_speed_sigma * to_seconds(motion.stamp - motion.from);
  Innovation<1> innovation;
  innovation.residual << travelled.displacement.z() - gain * distance * offset;
  innovation.H.setZero();
  innovation.H[index::climb_offset] = gain * distance;
  innovation.H[index::distance] = gain * offset;
  innovation.H[index::odometry_scale] = distance * offset;
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
  innovation.residual = rotation_vector(
      Eigen::Quaterniond(Matrix3d(motion.rotation.toRotationMatrix() * predicted.transpose())));
  innovation.H.setZero();
  innovation.H.middleCols<3>(index::azimuth) = R_clone_enu * attitude_rate_axes(now);
  innovation.H.middleCols<3>(index::clone_azimuth) = -R_clone_enu * attitude_rate_axes(clone);
  innovation.R = motion.covariance.bottomRightCorner<3, 3>() + floor * floor * Matrix3d::Identity();
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
    if (outcome.refused() && ++state.gated_in_a_row % parameters.recover_after == 0) {
      inflate(state, motion, parameters);
      ++state.recoveries;
      outcome = correct(state, motion, parameters);
    }
  }
  if (outcome.refused()) {
    ++state.odometry_refused;
  } else {
    ++state.odometry_applied;
    state.gated_in_a_row = 0;
    state.odometry_stamp = motion.stamp;
  }
  take_clone(state);
  return outcome;
}

}  // namespace maploop::fusion
