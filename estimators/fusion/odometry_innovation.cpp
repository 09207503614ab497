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
  return {to_arc * motion.translation, to_arc, turn};
}

Innovation<6> motion_innovation(const FilterState& state, const RelativeMotion& motion,
                                const FusionParameters& parameters) {
  using namespace index;
  const Attitude now = state.attitude();
  const Attitude clone = state.clone_attitude();
  const Matrix3d R_clone_enu = rotation_enu_body(clone).transpose();
  const Matrix3d axes_of_clone = attitude_rate_axes(clone);
  const Arc travelled = arc(motion);
  const Gain gain = gain_of(state, motion);
  const Vector3d moved = state.moved();
  const Matrix3d to_arc = travelled.to_arc * R_clone_enu;  // from enu

  Innovation<6> innovation;
  // (13) of METHOD.md
  innovation.residual[0] = travelled.displacement.x() - gain.value * state.x[distance];
  innovation.H.row(0) = state.x[distance] * gain.by_state.transpose();
  innovation.H(0, distance) = gain.value;
  // (14) of METHOD.md
  innovation.residual.segment<2>(1) = (travelled.displacement - to_arc * moved).tail<2>();
  innovation.residual[1] += travelled.displacement.x() * state.x[odometry_course];
  innovation.H(1, odometry_course) = -travelled.displacement.x();
  innovation.H.block<2, 3>(1, east) = to_arc.bottomRows<2>();
  innovation.H.block<2, 3>(1, clone_east) = -to_arc.bottomRows<2>();
  for (int i = 0; i < 3; ++i) {
    innovation.H.block<2, 1>(1, clone_azimuth + i) =
        (to_arc * moved.cross(axes_of_clone.col(i))).tail<2>();
  }
  // (36) of METHOD.md
  const Vector3d by_left = Vector3d::UnitY().cross(travelled.turn);
  innovation.residual.head<3>() -= by_left * state.x[odometry_left];
  innovation.H.block<3, 1>(0, odometry_left) = by_left;
  // (15) of METHOD.md
  const Matrix3d predicted = R_clone_enu * rotation_enu_body(now);
  innovation.residual.tail<3>() = rotation_vector(
      Eigen::Quaterniond(Matrix3d(motion.rotation.toRotationMatrix() * predicted.transpose())));
  innovation.H.block<3, 3>(3, azimuth) = R_clone_enu * attitude_rate_axes(now);
  innovation.H.block<3, 3>(3, clone_azimuth) = -R_clone_enu * axes_of_clone;
  if (by_ranges(motion)) {
    const double way = travelled.displacement.x();
    innovation.residual[5] -= way * state.x[lidar_turn];
    innovation.H(5, lidar_turn) = way;
  }
  Eigen::Matrix<double, 6, 6> to_rows = Eigen::Matrix<double, 6, 6>::Identity();
  to_rows.topLeftCorner<3, 3>() = travelled.to_arc;
  innovation.R = to_rows * motion.covariance * to_rows.transpose();
  const double least_way = parameters.min_speed_sigma * to_seconds(motion.stamp - motion.from);
  innovation.R.diagonal().head<3>().array() += least_way * least_way;
  innovation.R.diagonal().tail<3>().array() +=
      parameters.min_rotation_sigma * parameters.min_rotation_sigma;
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
