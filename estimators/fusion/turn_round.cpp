#include "estimators/fusion/turn_round.h"

#include <Eigen/Geometry>
#include <initializer_list>
#include <numbers>

#include "msgs/frames.h"

namespace maploop::fusion {

namespace {

void negate(FilterState& state, std::initializer_list<int> indices) {
  for (const int i : indices) {
    state.P.row(i) *= -1.0;
    state.P.col(i) *= -1.0;
  }
}

}  // namespace

void turn_heading(FilterState& state) {
  using namespace index;
  StateVector& x = state.x;
  x[azimuth] = wrap_angle(x[azimuth] + std::numbers::pi);
  x[clone_azimuth] = wrap_angle(x[clone_azimuth] + std::numbers::pi);
  x[pitch] = -x[pitch] - 2.0 * x[climb_offset];
  x[clone_pitch] = -x[clone_pitch] - 2.0 * x[climb_offset];
  state.chained_azimuth = wrap_angle(state.chained_azimuth + std::numbers::pi);
  for (const int i : {roll, clone_roll}) x[i] = -x[i];
  negate(state, {pitch, clone_pitch, roll, clone_roll});
}

void turn_round(FilterState& state) {
  using namespace index;
  turn_heading(state);
  state.odom_at_clone.rotation *= Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()) *
                                  Eigen::Quaterniond::Identity();
  for (const int i : {speed, distance}) state.x[i] = -state.x[i];
  negate(state, {speed, distance});
}

}  // namespace maploop::fusion
