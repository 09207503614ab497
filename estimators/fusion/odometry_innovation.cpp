#include "estimators/fusion/odometry_innovation.h"

#include <Eigen/Geometry>
#include <cmath>

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
  // (13) of METHOD.md
  Innovation<1> innovation(travelled.displacement.x() - gain.value * state.x[index::distance],
                           travelled.covariance(0, 0) + floor * floor);
  innovation.H = state.x[index::distance] * gain.by_state.transpose();
  innovation.H[index::distance] = gain.value;
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
  // (14) of METHOD.md
  Innovation<1> innovation(travelled.displacement.z() - gain.value * distance * offset,
                           travelled.covariance(2, 2) + heave * heave + floor * floor);
  innovation.H = distance * offset * gain.by_state.transpose();
  innovation.H[index::climb_offset] = gain.value * distance;
  innovation.H[index::distance] = gain.value * offset;
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
  // (16) of METHOD.md
  Innovation<1> innovation(
      wrap_angle(state.chained_azimuth - state.x[azimuth] - state.x[chain_drift]),
      p.chained_azimuth_sigma * p.chained_azimuth_sigma);
  innovation.H[azimuth] = 1.0;
  innovation.H[chain_drift] = 1.0;
  return innovation;
}

}  // namespace maploop::fusion
