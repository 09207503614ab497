// Synthetic drives have an exactly known truth and the measurements of perfect or noisy sensors.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::testing {

// These functions of the time since the start (s) define the vehicle's motion. They must be smooth,
// since the sensors measure their derivatives.
struct MotionProfile {
  std::function<double(double)> speed = [](double) { return 10.0; };    // m/s
  std::function<double(double)> yaw_rate = [](double) { return 0.0; };  // rad/s, to the left
  std::function<double(double)> pitch = [](double) { return 0.0; };     // rad
  std::function<double(double)> roll = [](double) { return 0.0; };      // rad
  double azimuth = 0.0;                                                 // rad, at the start
};

struct SensorNoise {
  double gyro_bias = 0.0;                // rad/s
  double tilt_gyro_bias = 0.0;           // rad/s about body x, and less about body y
  double gyro_density = 0.0;             // rad/sqrt(s)
  double force_sigma = 0.0;              // m/s^2 per sample
  double odometry_speed_sigma = 0.0;     // m/s over one interval
  double odometry_rotation_sigma = 0.0;  // rad over one interval, each axis
  unsigned seed = 1;
};

// The truth is integrated once, at 1 ms, over a flat rotating Earth, including one second before
// the start and one after the end.
class SyntheticDrive {
 public:
  SyntheticDrive(const MotionProfile& profile, double duration, const Geodetic& origin);

  static Time at(double seconds);  // stamp of a time since the start

  Eigen::Isometry3d pose(double t) const;  // T_enu_body
  double speed(double t) const { return profile_.speed(t); }
  double azimuth(double t) const;
  double pitch(double t) const { return profile_.pitch(t); }
  double roll(double t) const { return profile_.roll(t); }
  Eigen::Vector3d velocity(double t) const;  // enu

  std::vector<ImuSample> imu(double rate, const SensorNoise& noise = {}) const;
  std::vector<RelativeMotion> odometry(double rate, const SensorNoise& noise = {}) const;
  GnssFix fix(double t, double velocity_delay = 0.0) const;
  // Returns wheel speeds with this relative error, every 0.1 s from `from` until `to` (s), each
  // available 20 ms later.
  std::vector<WheelSpeed> wheels(double from, double to, double scale = 0.0) const;

 private:
  MotionProfile profile_;
  double duration_;
  Geodetic origin_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<double> azimuths_;  // unwrapped
};

// Returns a place in Karlsruhe.
Geodetic test_origin();

}  // namespace maploop::testing
