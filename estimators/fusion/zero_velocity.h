// Standstill is detected here and used as a measurement (ZUPT and ZIHR).
#pragma once

#include "estimators/fusion/earth.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// Records whether odometry or the wheels show a standing vehicle.
void note_motion(Stillness& stillness, const RelativeMotion& motion, const FusionParameters& p);
void note_motion(Stillness& stillness, const WheelSpeed& sample, const FusionParameters& p);

// Returns whether the vehicle stands at this sample, `interval` s after the previous one. It does
// if the forward force was quiet for a second, the yaw rate is within the gyro bias's uncertainty,
// and the newest odometry or wheel speed of the last second shows standstill. Without such data the
// estimated speed must be near zero. The last condition is needed because a smooth road at constant
// speed is quiet too.
bool stands(FilterState& state, const ImuSample& sample, double interval,
            const FusionParameters& parameters);

// z = 0; h = speed, m/s.
Innovation<1> zero_velocity_innovation(const FilterState& state, double interval,
                                       const FusionParameters& parameters);
// z = yaw rate, rad/s; h = gyro bias + the Earth's rate about body up.
Innovation<1> zero_rate_innovation(const FilterState& state, const ImuSample& sample,
                                   double interval, const LocalEarth& earth,
                                   const FusionParameters& parameters);

}  // namespace maploop::fusion
