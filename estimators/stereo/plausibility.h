// What a road vehicle can do between two pairs (method.md 2.1 step 6).
#pragma once

#include <optional>

#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// `motion` in body over `seconds`; `last_velocity` (m/s, body) where the motion before is known.
// The acceleration is judged with three standard deviations of the motion's own noise to spare.
bool plausible(const RelativeMotion& motion, double seconds,
               const std::optional<Eigen::Vector3d>& last_velocity,
               const StereoParameters& parameters);

}  // namespace maploop::stereo
