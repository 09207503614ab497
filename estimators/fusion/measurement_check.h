// These checks decide whether a measurement can be used at all, independent of the filter's state.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// Returns whether the sample is stamped later than it was delivered, by more than
// `max_stamp_ahead`. A sensor with a fast clock would make the data of all other sensors look late,
// so its samples must not reach the history.
bool stamped_after_delivery(const Sample& sample, const FusionParameters& parameters);

// These return Reason::none or the reason for refusing the measurement. Odometry that reports a
// failure is not checked further because its stamp still ends an interval, except after bad input:
// then it describes no interval and is refused.
Reason check_sample(const ImuSample& sample, const FusionParameters& parameters);
Reason check_wheel(const WheelSpeed& sample, const FusionParameters& parameters);
Reason check_motion(const RelativeMotion& motion, const FusionParameters& parameters);

}  // namespace maploop::fusion
