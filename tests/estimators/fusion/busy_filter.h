// A filter in the middle of a drive, all of whose states differ from zero, and a motion that
// agrees.
#pragma once

#include <cmath>

#include "estimators/fusion/filter_state.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::testing {

inline fusion::FilterState busy() {
  fusion::FilterState state;
  state.stamp = state.clone_stamp = state.start = SyntheticDrive::at(1.0);
  state.x = busy_state();
  state.P = busy_covariance();
  state.imu_stamp = state.stamp;
  state.acceleration = 1.3;
  state.front_known = true;
  return state;
}

// Returns a motion that agrees exactly with the state.
inline RelativeMotion agreeing_motion(const fusion::FilterState& state) {
  RelativeMotion m;
  m.status = OdometryStatus::ok;
  m.from = state.clone_stamp;
  m.stamp = m.from + from_seconds(0.1);
  m.rotation = Eigen::Quaterniond(Eigen::Matrix3d(
      rotation_enu_body(state.clone_attitude()).transpose() * rotation_enu_body(state.attitude())));
  const Eigen::AngleAxisd turn(m.rotation);
  const double half = 0.5 * turn.angle();
  const Eigen::Vector3d chord =
      rotation_enu_body(state.clone_attitude()).transpose() * state.moved();
  Eigen::Vector3d displacement =
      half / std::sin(half) * (Eigen::AngleAxisd(-half, turn.axis()) * chord);
  displacement.x() = state.x[fusion::index::distance];
  const Eigen::Vector3d place(0.0, state.x[fusion::index::odometry_left], 0.0);
  displacement -= turn.angle() * turn.axis().cross(place);
  displacement.y() -= displacement.x() * state.x[fusion::index::odometry_course];
  m.translation = std::sin(half) / half * (Eigen::AngleAxisd(half, turn.axis()) * displacement);
  m.covariance.diagonal() << 1e-4, 2e-4, 3e-4, 1e-7, 2e-7, 3e-7;
  return m;
}

}  // namespace maploop::testing
