#include "ppp/filter/map_update.h"

#include <cmath>

#include "ppp/filter/row_update.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

// Returns the unit vector to the right of the line, earth-fixed.
Eigen::Vector3d right_of(const MapFeedback& f) {
  return rotation_enu_ecef(f.point).topRows<2>().transpose() * right_of_line(f);
}

// `own` and `map` are the total variances of the filter and of the map.
MapUse apply(FilterState& state, const LinearRow& row, double own, double map,
             const PppParameters& parameters, Eigen::VectorXd& dx) {
  if (row.y * row.y > parameters.map_gate * (own + map)) return MapUse::gated;
  apply_row(state, row, dx);
  return MapUse::used;
}

MapUse apply_direction(FilterState& state, const MapFeedback& feedback,
                       const PppParameters& parameters, Eigen::VectorXd& dx) {
  const LinearRow row = direction_row(state, feedback, parameters.map_slip);
  const Eigen::Map<const Eigen::Vector3d> right(row.h.data());
  const double own = right.dot(state.P().block<3, 3>(S::velocity, S::velocity) * right);
  const double share = parameters.map_useful_share;
  if (own <= share * share * row.variance) return MapUse::no_help;
  return apply(state, row, own, row.variance, parameters, dx);
}

MapUse apply_line(FilterState& state, const MapFeedback& feedback, double since,
                  const Eigen::Matrix2d& covariance, const PppParameters& parameters,
                  Eigen::VectorXd& dx) {
  const LinearRow row = line_row(state, feedback, since);
  const double datum = parameters.map_datum_sigma;
  const double map = row.variance + feedback.lane_sigma * feedback.lane_sigma + datum * datum;
  return apply(state, row, variance_across(feedback, covariance), map, parameters, dx);
}

bool usable(const MapFeedback& f) {
  return all_finite(f) && has_sigmas(f) && f.probability > 0.0 && f.probability <= 1.0;
}

}  // namespace

LinearRow line_row(const FilterState& state, const MapFeedback& feedback, double since) {
  const Eigen::Vector3d right = right_of(feedback);
  const auto x = state.x();
  const Eigen::Vector3d off = x.segment<3>(S::position) + since * x.segment<3>(S::velocity) -
                              ecef_from_geodetic(feedback.point);
  LinearRow row;
  for (int i = 0; i < 3; ++i) row.add(S::position + i, right[i]);
  for (int i = 0; i < 3; ++i) row.add(S::velocity + i, since * right[i]);
  const Eigen::Vector2d level = right_of_line(feedback);
  for (int i = 0; i < 2; ++i) row.add(S::map_datum + i, -level[i]);
  row.add(S::lane_offset, -feedback.lane_sigma);
  // (21) of METHOD.md
  row.y = feedback.lane_sigma * x[S::lane_offset] - right.dot(off) +
          level.dot(x.segment<2>(S::map_datum));
  const double white = feedback.cross_sigma * feedback.cross_sigma;
  const double all = white + feedback.lane_sigma * feedback.lane_sigma;
  row.variance = white + all * (1.0 / feedback.probability - 1.0);
  return row;
}

LinearRow direction_row(const FilterState& state, const MapFeedback& feedback, double slip) {
  const Eigen::Vector3d right = right_of(feedback);
  const Eigen::Vector3d velocity = state.x().segment<3>(S::velocity);
  LinearRow row;
  for (int i = 0; i < 3; ++i) row.add(S::velocity + i, right[i]);
  row.y = -right.dot(velocity);  // (22) of METHOD.md
  const double across = velocity.norm() * feedback.azimuth_sigma;
  row.variance = (across * across + slip * slip) / feedback.probability;
  return row;
}

void begin_map_states(FilterState& state, const PppParameters& parameters) {
  for (int i = 0; i < 2; ++i) state.set(S::map_datum + i, 0.0, parameters.map_datum_sigma);
  state.set(S::lane_offset, 0.0, 1.0);
}

void predict_map_states(FilterState& state, double interval, const PppParameters& parameters) {
  const double way = interval * state.x().segment<3>(S::velocity).norm();
  state.forget(S::lane_offset, std::exp(-way / parameters.map_lane_length), 1.0);
}

void enter_road(FilterState& state, const PppParameters& parameters) {
  state.forget(S::lane_offset, parameters.map_lane_lasting, 1.0);
}

double map_variance(const MapFeedback& feedback) {
  return feedback.lane_sigma * feedback.lane_sigma + feedback.cross_sigma * feedback.cross_sigma;
}

double variance_across(const MapFeedback& feedback, const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d right = right_of_line(feedback);
  return right.dot(covariance * right);
}

MapUse apply_map(FilterState& state, const MapFeedback& feedback, double since,
                 const Eigen::Matrix2d& covariance, const PppParameters& parameters,
                 Eigen::VectorXd& dx) {
  if (!feedback.position && !feedback.azimuth) return MapUse::nothing_fed_back;
  if (!usable(feedback)) return MapUse::not_usable;
  if (feedback.new_road) enter_road(state, parameters);
  MapUse use = MapUse::nothing_fed_back;
  if (feedback.azimuth) use = apply_direction(state, feedback, parameters, dx);
  if (feedback.position) use = apply_line(state, feedback, since, covariance, parameters, dx);
  return use;
}

}  // namespace maploop::ppp
