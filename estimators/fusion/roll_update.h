// Levelling of the roll by the left accelerometer. The pitch needs no counterpart:
// the forward accelerometer drives the speed, and odometry's correction of the speed levels the
// pitch through their correlation; (f - a) / g with the filter's own a would be circular.
#pragma once

#include <optional>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "msgs/imu.h"

namespace maploop::fusion {

// z = left specific force; h = V w + g (cos p sin r) + bias, the centripetal acceleration and
// gravity along the local vertical. `interval` is the time since the IMU sample before, s; samples
// closer than `tilt_time` share their disturbance and count for less each. Nothing while the
// vehicle accelerates more than the limits.
std::optional<Innovation<1>> roll_innovation(const FilterState& state, const ImuSample& sample,
                                             double interval, const LocalEarth& earth,
                                             const FusionParameters& parameters);

}  // namespace maploop::fusion
