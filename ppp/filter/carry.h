// Predicts the position with a motion that other sensors have measured.
#pragma once

#include "ppp/carried_motion.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// Moves the position by the motion and replaces the velocity by it, both without the estimated
// errors of its direction and length. These errors are two entries of the state, first-order
// Gauss-Markov processes, which begin with the first motion; what is left is white.
void carry(FilterState& state, const CarriedMotion& motion, const PppParameters& parameters);

}  // namespace maploop::ppp
