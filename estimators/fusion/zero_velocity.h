// Standing still: seen, and used (ZUPT and ZIHR).
#pragma once

#include "estimators/fusion/earth.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// What odometry and the wheels tell the detector.
void note_motion(Stillness& stillness, const RelativeMotion& motion, const FusionParameters& p);
void note_motion(Stillness& stillness, const WheelSpeed& sample, const FusionParameters& p);

// Does the vehicle stand at this sample, `interval` after the one before (s)? The forward force has
// been quiet for a second, nothing turns, and the newest word of odometry or wheels within the last
// second is that it stands; without such a word the speed itself must be near zero. A smooth road
// at constant speed is quiet too: hence the last condition.
bool stands(FilterState& state, const ImuSample& sample, double interval,
            const FusionParameters& parameters);

// z = 0; h = speed.
Innovation<1> zero_velocity_innovation(const FilterState& state, double interval,
                                       const FusionParameters& parameters);
// z = yaw rate; h = gyro bias + the Earth's rate.
Innovation<1> zero_rate_innovation(const FilterState& state, const ImuSample& sample,
                                   double interval, const LocalEarth& earth,
                                   const FusionParameters& parameters);

}  // namespace maploop::fusion
