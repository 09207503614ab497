// The left accelerometer levels the roll. The pitch needs no counterpart: the forward accelerometer
// drives the speed, and odometry's correction of the speed levels the pitch through their
// correlation. Levelling it with (f - a) / g, where a is the filter's own acceleration, would be
// circular.
#pragma once

#include <optional>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "msgs/imu.h"

namespace maploop::fusion {

// z = left specific force, m/s^2; h = V w + g (cos p sin r) + bias: the centripetal acceleration,
// and gravity along the local vertical. `interval` is the time since the previous IMU sample in s.
// Samples closer than `tilt_time` share their disturbance, so each has less weight. Returns nothing
// if the interval is not positive or the vehicle accelerates beyond `max_acceleration` or
// `max_lateral_acceleration`.
std::optional<Innovation<1>> roll_innovation(const FilterState& state, const ImuSample& sample,
                                             double interval, const LocalEarth& earth,
                                             const FusionParameters& parameters);

}  // namespace maploop::fusion
