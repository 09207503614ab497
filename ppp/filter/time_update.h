// Predicts the filter's state to the next epoch.
#pragma once

#include "ppp/carried_motion.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/parameters.h"
#include "ppp/products/ephemeris.h"

namespace maploop::ppp {

// Sets the first state at a position (m, earth-fixed). Clocks and ambiguities are added later.
void begin_state(FilterState& state, const Eigen::Vector3d& position,
                 const PppParameters& parameters);

// Sets the position alone anew, uncorrelated with all else, which stays.
void begin_position(FilterState& state, const Eigen::Vector3d& position,
                    const PppParameters& parameters);

// Predicts over `interval` s, which are negative backward in time. A kinematic receiver moves as
// `carried` says; if that is nullptr, with constant velocity under white acceleration. Delays,
// clock offsets and ambiguities are random walks. The errors of orbits are predicted where their
// size is known (satellite_tracker.h).
void predict_state(FilterState& state, double interval, const CarriedMotion* carried,
                   const Ephemeris& ephemeris, const PppParameters& parameters);

}  // namespace maploop::ppp
