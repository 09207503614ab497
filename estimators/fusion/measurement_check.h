// Can a measurement be used at all, whatever the filter believes?
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"

namespace maploop::fusion {

// Reason::none, or why not. Odometry that reports a failure itself is not looked at further: its
// stamp still counts.
Reason check_sample(const ImuSample& sample, const FusionParameters& parameters);
Reason check_motion(const RelativeMotion& motion, const FusionParameters& parameters);

}  // namespace maploop::fusion
