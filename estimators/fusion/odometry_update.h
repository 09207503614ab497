// Odometry corrects the state by the distance travelled over its interval and by the rotation since
// the interval's start (stochastic clone: Roumeliotis and Burdick 2002).
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "estimators/fusion/outcome.h"
#include "msgs/odometry.h"

namespace maploop::fusion {

// The translation is expressed in the attitude half-way through the interval and scaled from chord
// to arc. At a constant turn rate its x is the distance travelled (negative in reverse), and its y
// and z show the direction of travel in the body frame. With a rotation by the angle a, the chord
// lies a/2 away from the forward axis, and its length is sin(a/2) / (a/2) of the arc's.
struct Arc {
  Eigen::Vector3d displacement;  // m
  Eigen::Matrix3d covariance;    // m^2
};
Arc arc(const RelativeMotion& motion);

// z = forward displacement, m; h = distance as the visual odometry measures it. For a LiDAR's
// motion, h has the LiDAR's scale instead of the speed sensor's. This is exact for any speed
// profile, as the filter integrates its own speed over the same interval.
Innovation<1> distance_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// z = upward displacement, m; h = (h of the distance) * climb offset.
Innovation<1> climb_innovation(const FilterState& state, const RelativeMotion& motion,
                               const FusionParameters& parameters);

// z = rotation; h = R(clone)^T R(now), which for a LiDAR's motion is turned further by its turning
// error. The residual is a rotation vector (rad) in the body frame at `from`, in which the
// odometry's covariance is given too.
Innovation<3> rotation_innovation(const FilterState& state, const RelativeMotion& motion,
                                  const FusionParameters& parameters);

// z = azimuth chained from odometry alone (thesis); h = azimuth + drift of the chain, rad.
Innovation<1> chained_azimuth_innovation(const FilterState& state,
                                         const FusionParameters& parameters);

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
