// This file defines a sample of the reduced IMU: two horizontal accelerometers and one vertical
// gyro.
#pragma once

#include "msgs/sample.h"

namespace maploop {

struct ImuSample : Sample {
  double specific_force_forward = 0.0;  // m/s^2, along body x; contains gravity when pitched
  double specific_force_left = 0.0;     // m/s^2, along body y
  double yaw_rate = 0.0;                // rad/s about body z, positive when turning left

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), specific_force_forward, specific_force_left, yaw_rate);
  }
};

}  // namespace maploop
