#include "ppp/filter/time_update.h"

#include <cmath>

#include "ppp/filter/carry.h"
#include "ppp/filter/height_update.h"
#include "ppp/filter/map_update.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

// The horizontal velocity walks. The vertical one, which the slopes of roads bound, is a
// first-order Gauss-Markov process, and the position its integral.
void move(FilterState& state, double t, const PppParameters& parameters) {
  auto x = state.x();
  auto P = state.P();
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(x.segment<3>(S::position)));
  const auto in_ecef = [&R](double horizontal, double vertical) -> Eigen::Matrix3d {
    return R.transpose() * Eigen::Vector3d(horizontal, horizontal, vertical).asDiagonal() * R;
  };
  const double elapsed = std::abs(t), sign = t < 0.0 ? -1.0 : 1.0;
  const double time = parameters.vertical_speed_time, keep = std::exp(-elapsed / time);
  const Eigen::Matrix3d way = in_ecef(t, sign * time * (1.0 - keep)), kept = in_ecef(1.0, keep);

  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, S::capacity> velocity_rows =
      P.middleRows<3>(S::velocity);
  x.segment<3>(S::position) += way * x.segment<3>(S::velocity);
  x.segment<3>(S::velocity) = (kept * x.segment<3>(S::velocity)).eval();
  P.middleRows<3>(S::position) += way.lazyProduct(velocity_rows);
  P.middleRows<3>(S::velocity) = kept.lazyProduct(velocity_rows);
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, S::capacity, 3> velocity_columns =
      P.middleCols<3>(S::velocity);
  P.middleCols<3>(S::position) += velocity_columns.lazyProduct(way);
  P.middleCols<3>(S::velocity) = velocity_columns.lazyProduct(kept);

  const double q = parameters.horizontal_acceleration;
  const double speed = parameters.vertical_speed_sigma * parameters.vertical_speed_sigma;
  P.block<3, 3>(S::position, S::position) +=
      in_ecef(q * elapsed * elapsed * elapsed / 3.0,
              speed * time * time * (2.0 * elapsed / time - 3.0 + 4.0 * keep - keep * keep));
  const Eigen::Matrix3d between =
      in_ecef(q * t * elapsed / 2.0, sign * speed * time * (1.0 - keep) * (1.0 - keep));
  P.block<3, 3>(S::position, S::velocity) += between;
  P.block<3, 3>(S::velocity, S::position) += between;
  P.block<3, 3>(S::velocity, S::velocity) += in_ecef(q * elapsed, speed * (1.0 - keep * keep));
}

}  // namespace

void begin_position(FilterState& state, const Eigen::Vector3d& position,
                    const PppParameters& parameters) {
  for (int i = 0; i < 3; ++i) state.set(S::position + i, position[i], parameters.position_sigma);
}

void begin_state(FilterState& state, const Eigen::Vector3d& position,
                 const PppParameters& parameters) {
  const bool moves = parameters.motion == Motion::kinematic;
  state.clear();
  begin_position(state, position, parameters);
  for (int i = 0; i < 3; ++i)
    state.set(S::velocity + i, 0.0, moves ? parameters.velocity_sigma : 0.0);
  state.set(S::zenith_wet, 0.0, parameters.zenith_wet_sigma);
  if (parameters.gradients) {
    state.set(S::gradient_north, 0.0, parameters.gradient_sigma);
    state.set(S::gradient_east, 0.0, parameters.gradient_sigma);
  }
  begin_map_states(state, parameters);
}

void predict_state(FilterState& state, double interval, const CarriedMotion* carried,
                   const Ephemeris& ephemeris, const PppParameters& parameters) {
  if (parameters.motion == Motion::kinematic) {
    if (carried != nullptr) {
      carry(state, *carried, parameters);
    } else {
      move(state, interval, parameters);
    }
    predict_map_states(state, std::abs(interval), parameters);
    predict_height_states(state, std::abs(interval), parameters.ground);
  }
  auto P = state.P();
  const auto walk = [&](int index, double density) {
    P(index, index) += density * density * std::abs(interval);
  };
  walk(S::zenith_wet, parameters.zenith_wet_walk);
  if (parameters.gradients) {
    walk(S::gradient_north, parameters.gradient_walk);
    walk(S::gradient_east, parameters.gradient_walk);
  }
  for (const int i : {S::zenith_ionosphere, S::ionosphere_north, S::ionosphere_east}) {
    walk(i, parameters.ionosphere_walk);
  }
  // Only those that are in use have a variance.
  for (int i = S::system_offset; i < S::fixed; ++i) {
    if (P(i, i) > 0.0) walk(i, parameters.system_offset_walk);
  }
  for (int i = S::fixed; i < state.size(); ++i) {
    const auto [satellite, part] = state.entries()[static_cast<std::size_t>(i - S::fixed)];
    if (part == Part::ionosphere) {
      const bool measured = state.find(satellite, Part::ionosphere_ambiguity) >= 0;
      walk(i, measured ? parameters.measured_ionosphere_walk : parameters.slant_ionosphere_walk);
    }
    if (part == Part::ambiguity)
      walk(i, std::hypot(parameters.ambiguity_walk, ephemeris.error_walk(satellite)));
  }
}

}  // namespace maploop::ppp
