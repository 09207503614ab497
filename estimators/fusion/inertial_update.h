// An inertial sample corrects the roll by gravity, and at standstill speed and gyro bias (ZUPT and
// ZIHR).
#pragma once

#include <optional>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// z = left specific force, m/s^2; h = V w + g (cos p sin r) + bias: the centripetal acceleration,
// and gravity along the local vertical. `interval` is the time since the previous IMU sample in s.
// Samples closer than `tilt_time` share their disturbance, so each has less weight. Returns nothing
// if the interval is not positive or the vehicle accelerates beyond `max_acceleration` or
// `max_lateral_acceleration`.
std::optional<Innovation<1>> roll_innovation(const FilterState& state, const ImuSample& sample,
                                             double interval, const LocalEarth& earth,
                                             const FusionParameters& parameters);

// z = upward specific force of a full unit that stands, m/s^2; h = g (cos p cos r) + bias. While
// the vehicle moves, its springs would pass for errors of pitch and speed. The weight is that of
// the roll.
Innovation<1> up_innovation(const FilterState& state, const ImuSample& sample, double interval,
                            const LocalEarth& earth, const FusionParameters& parameters);

// Records whether odometry or the wheels show a standing vehicle.
void note_motion(Stillness& stillness, const RelativeMotion& motion, const FusionParameters& p);
void note_motion(Stillness& stillness, const WheelSpeed& sample, const FusionParameters& p);

// Returns whether the vehicle stands at this sample, `interval` s after the previous one. It does
// if the forward force was quiet for a second, the yaw rate is within the gyro bias's uncertainty,
// and the newest odometry or wheel speed of the last second shows standstill. Without such data the
// estimated speed must be near zero. The last condition is needed because a smooth road at constant
// speed is quiet too. With `still_by_inertia`, no other sensor is needed where both forces and the
// yaw rate are quieter than on any road, and the estimated speed is within three sigma of a creep.
bool stands(FilterState& state, const ImuSample& sample, double interval,
            const FusionParameters& parameters);

// z = 0; h = speed, m/s.
Innovation<1> zero_velocity_innovation(const FilterState& state, double interval,
                                       const FusionParameters& parameters);
// z = yaw rate, rad/s; h = gyro bias + the Earth's rate about body up.
Innovation<1> zero_rate_innovation(const FilterState& state, const ImuSample& sample,
                                   double interval, const LocalEarth& earth,
                                   const FusionParameters& parameters);
// z = the rates about body x (axis 0) and y (axis 1), rad/s, of a full unit; h is the same.
Innovation<1> zero_tilt_rate_innovation(const FilterState& state, const ImuSample& sample, int axis,
                                        double interval, const LocalEarth& earth,
                                        const FusionParameters& parameters);

}  // namespace maploop::fusion
