// What is known of the vehicle at one moment.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "msgs/local_frame.h"
#include "msgs/time.h"

namespace maploop::mapmatch {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Whatever is `unknown` is done without. `stamp` is the position's.
struct VehicleFix {
  Time stamp{};
  Geodetic position;                                                // its height does not matter
  Eigen::Matrix2d covariance = 25.0 * Eigen::Matrix2d::Identity();  // m^2, east and north
  double speed = unknown;                                           // m/s, forward
  double speed_sigma = 0.3;                                         // m/s
  double azimuth = unknown;                                         // rad, of the vehicle
  double azimuth_sigma = 0.05;                                      // rad
  double yaw_rate = unknown;        // rad/s, positive when turning left
  double hdop = unknown;            // where unknown, from the covariance
  double visual_speed = unknown;    // m/s, of visual odometry
  double visual_azimuth = unknown;  // rad, of visual odometry: only its changes count
};

}  // namespace maploop::mapmatch
