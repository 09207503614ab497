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
  Eigen::Matrix3d to_arc;        // turns and scales the translation to it
  Eigen::Vector3d turn;          // rad, the rotation vector
};
Arc arc(const RelativeMotion& motion);

// Compares a motion with the pose relative to the clone, in the order of MotionDirection. The first
// three rows are the arc's displacement (m), with R the motion's covariance:
//   along       h = distance as the speed sensor measures it, which is exact for any speed profile;
//               for a LiDAR's motion it has the LiDAR's scale instead
//   across, up  h = displacement of the position, turned like the arc
// The last three are the rotation as a rotation vector (rad) in the body frame at `from`: h =
// R(clone)^T R(now), which for a LiDAR's motion is turned further by its turning error. The
// displacement is that of the body with the error of odometry's place, which swings in turns.
Innovation<6> motion_innovation(const FilterState& state, const RelativeMotion& motion,
                                const FusionParameters& parameters);

// z = azimuth chained from odometry alone (thesis); h = azimuth + drift of the chain, rad.
Innovation<1> chained_azimuth_innovation(const FilterState& state,
                                         const FusionParameters& parameters);

}  // namespace maploop::fusion
