#include "ppp/filter/carry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using S = FilterState;

void keep(FilterState& state, int index, double sigma, double share) {
  if (state.P()(index, index) > 0.0) {
    state.forget(index, share, sigma * sigma);
  } else {
    state.set(index, 0.0, sigma);
  }
}

// Adds a vector of the motion to the three entries at `index`, by (27) of METHOD.md without noise.
void add(FilterState& state, int index, const Vector3d& of_motion, const Vector3d& up) {
  auto x = state.x();
  auto P = state.P();
  const double scale = 1.0 / (1.0 + x[S::carried_scale]);
  const Vector3d right = scale * (Eigen::AngleAxisd(-x[S::carried_turn], up) * of_motion);
  const Vector3d by_turn = -up.cross(right), by_scale = -scale * right;
  x.segment<3>(index) += right;
  P.middleRows<3>(index) += by_turn * P.row(S::carried_turn) + by_scale * P.row(S::carried_scale);
  P.middleCols<3>(index) +=
      P.col(S::carried_turn) * by_turn.transpose() + P.col(S::carried_scale) * by_scale.transpose();
}

}  // namespace

void carry(FilterState& state, const CarriedMotion& motion, const PppParameters& parameters) {
  const double elapsed = std::abs(motion.interval);
  keep(state, S::carried_turn, std::max(parameters.carried_turn_sigma, motion.turn_sigma),
       std::exp(-elapsed / parameters.carried_turn_time));
  keep(state, S::carried_scale, parameters.carried_scale_sigma,
       std::exp(-elapsed / parameters.carried_scale_time));
  const Vector3d up =
      rotation_enu_ecef(geodetic_from_ecef(state.x().segment<3>(S::position))).row(2).transpose();
  add(state, S::position, motion.displacement, up);
  for (int i = 0; i < 3; ++i) state.set(S::velocity + i, 0.0, 0.0);
  add(state, S::velocity, motion.velocity, up);

  const double walk = parameters.carried_walk, lever = motion.lever_sigma;
  const Matrix3d level = Matrix3d::Identity() - up * up.transpose();
  // The speed's error of this interval is that of the way as well.
  const Vector3d along = parameters.carried_speed_share * motion.velocity;
  const Matrix3d error = along * along.transpose() + parameters.carried_velocity_sigma *
                                                         parameters.carried_velocity_sigma *
                                                         Matrix3d::Identity();
  auto P = state.P();
  P.block<3, 3>(S::position, S::position) +=
      walk * walk * elapsed * Matrix3d::Identity() + lever * lever * level;
  P.block<3, 3>(S::position, S::position) += elapsed * elapsed * error;
  P.block<3, 3>(S::position, S::velocity) += motion.interval * error;
  P.block<3, 3>(S::velocity, S::position) += motion.interval * error;
  P.block<3, 3>(S::velocity, S::velocity) += error;
}

}  // namespace maploop::ppp
