// Correction by odometry: the distance travelled over its interval and the rotation from the
// interval's start (stochastic clone: Roumeliotis and Burdick 2002).
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/odometry.h"

namespace maploop::fusion {

// Translation seen from the attitude half-way through the interval, scaled from chord to arc: at a
// constant turn rate its x is the distance travelled (negative in reverse), and its y and z show
// the direction of travel in the body. The chord lies half the rotation away from the forward axis
// and is sin(a/2) / (a/2) of the arc, a being the angle of rotation.
struct Arc {
  Eigen::Vector3d displacement;  // m
  Eigen::Matrix3d covariance;    // m^2
};
Arc arc(const RelativeMotion& motion);

// z = forward displacement; h = distance as the visual odometry sees it, of a LiDAR's motion with
// the LiDAR's scale in place of that. Exact for any speed profile, as the filter integrates its own
// speed over the same interval.
Innovation<1> distance_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// z = upward displacement; h = that of the distance * climb offset.
Innovation<1> climb_innovation(const FilterState& state, const RelativeMotion& motion,
                               const FusionParameters& parameters);

// z = rotation; h = R(clone)^T R(now), a LiDAR's turned further by its error; the residual is a
// rotation vector in the body frame at `from`, where the odometry's covariance lives too.
Innovation<3> rotation_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// z = azimuth chained from odometry alone (thesis); h = azimuth + drift of the
// chain.
Innovation<1> chained_azimuth_innovation(const FilterState& state,
                                         const FusionParameters& parameters);

// Those corrections that the configuration asks for, all or none: an odometry that is wrong in
// speed (gate of 1 degree of freedom) or rotation (3) is not trusted in the rest. Climb has the
// gate of speed, but only skips itself.
//
// After `recover_after` gated motions in a row the prediction is the suspect, until a motion passes
// the gates by itself: its covariance is inflated by what it may have got wrong since it was last
// aided (`recoveries` counts) before the gates are asked again. A speed that a fix has just
// confirmed (held_by_fix) is not doubted: then the odometry is wrong. Where the motion goes as fast
// the other way, nose and tail were mistaken for each other and change places first.
//
// Counts in the state; takes the clone in every case. Precondition: state.stamp == motion.stamp.
Outcome apply_odometry(FilterState& state, const RelativeMotion& motion,
                       const FusionParameters& parameters);

}  // namespace maploop::fusion
