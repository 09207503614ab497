// These are the innovations of an odometry's motion: distance, climb and rotation over its
// interval.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
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

}  // namespace maploop::fusion
