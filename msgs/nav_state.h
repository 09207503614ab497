// This file defines the fused navigation solution.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop {

// States what a fused state is based on.
enum class NavStatus : std::uint8_t {
  uninitialized,   // no first fix yet; everything else is zero
  aided,           // odometry is being applied
  coasting,        // inertial only, for longer than the filter's limit
  without_course,  // a fix alone, too slow to show a direction: the azimuth is unknown
};

constexpr auto names_of(NavStatus) {
  return names_up_to<NavStatus::without_course>(
      {"uninitialized", "aided", "coasting", "without course"});
}

// This is the vehicle's position, velocity and attitude at `stamp`, fused from all sensors.
struct NavState : Sample {
  NavStatus status = NavStatus::uninitialized;             // what the rest is based on
  Geodetic origin;                                         // of enu
  Eigen::Vector3d position_enu = Eigen::Vector3d::Zero();  // m, the IMU's
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  // m/s
  Attitude attitude;                                       // of the body
  double forward_speed = 0.0;                              // m/s
  double gyro_bias = 0.0;  // rad/s, contained in the measured yaw rate
  // The order is position (m), velocity (m/s), then azimuth, pitch, roll (rad).
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  // These are the stamps of the newest measurement of each kind in this state (epoch 0: none yet).
  Time imu_stamp{};                     // inertial sample
  Time odometry_stamp{};                // relative motion
  Time gnss_stamp{};                    // GNSS fix
  Time wheel_stamp{};                   // wheel speed
  Time zero_velocity_stamp{};           // when the filter last used a standstill of the vehicle
  std::uint64_t odometry_applied = 0;   // relative motions used since the start
  std::uint64_t odometry_refused = 0;   // those not used, also because they were not ok
  std::uint64_t reinitializations = 0;  // how often the filter restarted at a fix

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), status, origin, position_enu, velocity_enu, attitude,
       forward_speed, gyro_bias, covariance, imu_stamp, odometry_stamp, gnss_stamp, wheel_stamp,
       zero_velocity_stamp, odometry_applied, odometry_refused, reinitializations);
  }
};

}  // namespace maploop
