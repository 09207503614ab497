// The fused state as an element of an array with fields.
#pragma once

#include <cstdint>

#include "msgs/odom_state.h"

namespace maploop::python {

// Fields are NavState's; attitude and position of the frame of odometry begin with odom_.
struct StateRecord {
  std::int64_t stamp;  // ns
  std::uint8_t status;
  double latitude, longitude, height;  // rad, rad, m
  double position_enu[3];              // m
  double velocity_enu[3];              // m/s
  double azimuth, pitch, roll;         // rad
  double forward_speed;                // m/s
  double gyro_bias;                    // rad/s
  double covariance[9][9];
  double odom_position[3];                                                    // m
  double odom_azimuth;                                                        // rad
  std::int64_t odometry_stamp, gnss_stamp, wheel_stamp, zero_velocity_stamp;  // ns
};

StateRecord record_of(const FusedState& state);

}  // namespace maploop::python
