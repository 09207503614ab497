// Can a measurement be used at all, whatever the filter believes?
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// Nothing is measured after it was delivered. A sensor whose clock is ahead would make everybody
// else's data look late, so it must not get as far as the history.
bool stamped_after_delivery(const Sample& sample, const FusionParameters& parameters);

// Reason::none, or why not. Odometry that reports a failure itself is not looked at further: its
// stamp still counts, unless its input was bad: then it says nothing about any interval.
Reason check_sample(const ImuSample& sample, const FusionParameters& parameters);
Reason check_wheel(const WheelSpeed& sample, const FusionParameters& parameters);
Reason check_motion(const RelativeMotion& motion, const FusionParameters& parameters);

}  // namespace maploop::fusion
