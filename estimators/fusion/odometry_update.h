// Odometry corrects the state by the distance travelled over its interval and by the rotation since
// the interval's start (stochastic clone: Roumeliotis and Burdick 2002).
#pragma once

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/odometry.h"

namespace maploop::fusion {

// Applies all corrections that the configuration asks for, or none of them: if odometry is wrong in
// speed (gate with 1 degree of freedom) or rotation (3), the rest is not trusted either. Climb has
// the same gate as speed, but a gated climb is only skipped.
//
// After `recover_after` consecutive gated motions the prediction is suspected, until a motion
// passes the gates. Its covariance is inflated by the error it may have accumulated since it was
// last aided, and the gates are tested again (`recoveries` counts the successes). A speed that a
// fix has just confirmed (held_by_fix) is not doubted: then the odometry is wrong. If the motion is
// equally fast in the opposite direction, front and rear of the vehicle were confused and are
// exchanged first.
//
// Updates the counters in the state, and takes the clone in every case. Precondition: state.stamp
// == motion.stamp.
Outcome apply_odometry(FilterState& state, const RelativeMotion& motion,
                       const FusionParameters& parameters);

}  // namespace maploop::fusion
