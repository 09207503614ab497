// A fix holds what is known about the vehicle at one time.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "msgs/local_frame.h"
#include "msgs/time.h"

namespace maploop::mapmatch {

// This value (NaN) stands for what is not known.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Fields that are `unknown` are not used. `stamp` is that of the position.
struct VehicleFix {
  Time stamp{};                                                     // UTC
  Geodetic position;                                                // height is ignored
  Eigen::Matrix2d covariance = 25.0 * Eigen::Matrix2d::Identity();  // m^2, east and north
  double speed = unknown;                                           // m/s, forward
  double speed_sigma = 0.3;                                         // m/s
  double azimuth = unknown;                                         // rad, of the vehicle
  double azimuth_sigma = 0.05;                                      // rad
  double yaw_rate = unknown;        // rad/s, positive when turning left
  double hdop = unknown;            // if unknown, computed from the covariance
  double visual_speed = unknown;    // m/s, of visual odometry
  double visual_azimuth = unknown;  // rad, of visual odometry; only its changes matter
};

}  // namespace maploop::mapmatch
