#include "ppp/filter/height_update.h"

#include <cmath>

#include "ppp/filter/row_update.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

void open_height_states(FilterState& state, const HeightModel& heights, const GroundParameters& p) {
  state.set(S::ground_datum, 0.0, heights.above_ellipsoid() ? p.datum_sigma : p.no_geoid_sigma);
  state.set(S::ground_error, 0.0, p.error_sigma);
}

bool in_use(const FilterState& state) {
  return state.P()(S::ground_error, S::ground_error) > 0.0;
}

}  // namespace

LinearRow height_row(const FilterState& state, const Ground& ground,
                     const GroundParameters& parameters) {
  const auto x = state.x();
  const Eigen::Vector3d position = x.segment<3>(S::position);
  const Geodetic place = geodetic_from_ecef(position);
  const Eigen::Matrix3d R = rotation_enu_ecef(place);
  const Eigen::Vector3d to_ground =
      R.row(2) - ground.slope.x() * R.row(0) - ground.slope.y() * R.row(1);
  LinearRow row;
  for (int i = 0; i < 3; ++i) row.add(S::position + i, to_ground[i]);
  row.add(S::ground_datum, -1.0);
  row.add(S::ground_error, -1.0);
  // (23) of METHOD.md
  row.y = ground.height - parameters.surface + parameters.antenna_height + x[S::ground_datum] +
          x[S::ground_error] - place.height;
  const Eigen::Matrix<double, 2, 3> level = R.topRows<2>();
  const double horizontal =
      (level * state.P().block<3, 3>(S::position, S::position) * level.transpose()).trace();
  // (24) of METHOD.md
  row.variance = parameters.noise * parameters.noise +
                 parameters.slope_sigma * parameters.slope_sigma * horizontal;
  return row;
}

void predict_height_states(FilterState& state, double interval,
                           const GroundParameters& parameters) {
  if (!in_use(state)) return;
  const double way = interval * state.x().segment<3>(S::velocity).norm();
  const double sigma = parameters.error_sigma;
  state.forget(S::ground_error, std::exp(-way / parameters.error_length), sigma * sigma);
}

HeightUse apply_height(FilterState& state, const HeightModel& heights,
                       const GroundParameters& parameters, Eigen::VectorXd& dx) {
  const Ground ground = heights.at(geodetic_from_ecef(state.x().segment<3>(S::position)));
  if (ground.use != HeightUse::used) return ground.use;
  if (!in_use(state)) open_height_states(state, heights, parameters);
  const LinearRow row = height_row(state, ground, parameters);
  const double variance = predicted_variance(state, row) + row.variance;
  if (row.y * row.y > parameters.gate * variance) return HeightUse::gated;
  apply_row(state, row, dx);
  return HeightUse::used;
}

}  // namespace maploop::ppp
