// Correction by odometry: the distance travelled over its interval and the rotation from the
// interval's start (stochastic clone: Roumeliotis and Burdick 2002; method.md 1.4).
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/odometry.h"

namespace maploop::fusion {

// Length of the arc from `from` to `stamp` at constant turn rate, m; negative in reverse. The
// chord lies half the rotation away from the forward axis and is sin(a/2) / (a/2) of the arc.
struct Arc {
  double length = 0.0;
  double variance = 0.0;  // m^2
};
Arc arc_length(const RelativeMotion& motion);

// z = arc length; h = (1 + scale) distance. Exact for any speed profile over the interval, as the
// filter integrates its own speed over the same interval.
Innovation<1> distance_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// z = rotation; h = R(clone)^T R(now); the residual is a rotation vector in the body frame at
// `from`, where the odometry's covariance lives too.
Innovation<3> rotation_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// Both corrections, or neither: an odometry that is wrong in one is not trusted in the other.
// After `recover_after` gated motions in a row the prediction is the suspect: its covariance is
// inflated (`recoveries` counts) before the gates are asked again. Counts in the state; takes the
// clone in every case. Precondition: state.stamp == motion.stamp.
Outcome apply_odometry(FilterState& state, const RelativeMotion& motion,
                       const FusionParameters& parameters);

}  // namespace maploop::fusion
