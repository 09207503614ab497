// These are the parameters of the reduced-IMU filter, chosen from the physics of a road vehicle and
// its sensors; parameter_table.cpp describes each.
#pragma once

#include <cstdint>

#include "msgs/named_enum.h"

namespace maploop::fusion {

// Which axes of the inertial unit the filter uses, where a sample has all six.
enum class InertialAxes : std::uint8_t {
  automatic,  // six where neither odometry nor wheels measure the speed, else three
  three,      // the reduced unit: forward and left force, yaw rate
  six,
};

constexpr auto names_of(InertialAxes) {
  return names_up_to<InertialAxes::six>({"auto", "three", "six"});
}

struct FusionParameters {
  // Which measurements correct the state. A named configuration (configuration.h) sets these.
  bool use_gnss = false;
  bool use_odometry_speed = true;
  bool use_odometry_azimuth = true;
  bool chain_odometry_azimuth = false;
  bool use_wheel_speed = false;
  bool use_zero_velocity = true;
  bool still_by_inertia = false;
  bool speed_from_turns = false;
  InertialAxes inertial_axes = InertialAxes::automatic;

  // History and time.
  double history_length = 3.0;  // s
  int history_capacity = 512;
  double confirm_gap = 1.0;       // s
  double max_gap = 5.0;           // s
  double max_stamp_ahead = 0.05;  // s
  int restart_after = 100;
  double max_step = 0.05;             // s
  double imu_hold = 0.3;              // s
  double repeat_speed = 2.0;          // m/s
  double imu_bridge = 2.0;            // s
  double coasting_after = 1.0;        // s
  double max_interval = 1.0;          // s
  double max_origin_distance = 50e3;  // m

  // Start, from one GNSS fix.
  double min_course_speed = 2.0;       // m/s
  double max_stamp_offset = 0.2;       // s
  double min_position_sigma = 0.1;     // m
  double min_velocity_sigma = 0.03;    // m/s
  double start_course_sigma = 0.0087;  // rad (0.5 deg)
  double start_slope_sigma = 0.0087;   // rad (0.5 deg)
  double start_roll_sigma = 0.035;     // rad (2 deg)
  double start_acceleration = 3.0;     // m/s^2

  // Inertial sensors.
  double gyro_noise = 8.7e-5;           // rad/sqrt(s) (0.3 deg/sqrt(h))
  double gyro_turn_on_sigma = 1.75e-4;  // rad/s (36 deg/h)
  double gyro_bias_sigma = 4.8e-5;      // rad/s (10 deg/h)
  double gyro_bias_time = 300.0;        // s
  double gyro_scale_sigma = 0.003;
  double turn_time = 3.0;                     // s
  double acceleration_noise = 0.3;            // m/s/sqrt(s)
  double accelerometer_turn_on_sigma = 0.05;  // m/s^2 (0.3 deg of tilt)
  double accelerometer_bias_sigma = 0.01;     // m/s^2
  double accelerometer_bias_time = 300.0;     // s
  double yaw_acceleration = 0.3;              // rad/s^2
  double jerk = 2.0;                          // m/s^3
  double silent_yaw_noise = 0.3;              // rad/sqrt(s)
  double silent_speed_noise = 2.0;            // m/s/sqrt(s)
  double max_specific_force = 50.0;           // m/s^2
  double max_yaw_rate = 6.0;                  // rad/s (350 deg/s)

  // Vehicle.
  double pitch_noise = 0.0175;           // rad/sqrt(s) (1 deg)
  double roll_noise = 0.0175;            // rad/sqrt(s) (1 deg)
  double rear_axle_distance = 0.0;       // m
  double rear_slip = 0.005;              // rad/(m/s^2), 2.8 deg at 1 g
  double rear_slip_sigma = 0.003;        // rad/(m/s^2)
  double rear_axle_sigma = 0.5;          // m
  double slip_sigma = 0.005;             // rad (0.3 deg)
  double heave_sigma = 0.02;             // rad (1.1 deg)
  double slip_time = 1.0;                // s
  double climb_offset = 0.0;             // rad
  double climb_offset_sigma = 0.0175;    // rad (1 deg)
  double climb_offset_time = 300.0;      // s
  double imu_delay_sigma = 0.0;          // s; 0: the delay is as described
  double odometry_course_sigma = 0.035;  // rad (2 deg)
  double odometry_course_walk = 1e-4;    // rad/sqrt(s)
  double odometry_lever_sigma = 0.3;     // m
  double max_tilt = 0.8;                 // rad

  // A unit of six axes.
  double tilt_rate_noise = 1e-4;              // rad/sqrt(s) (0.3 deg/sqrt(h))
  double levelled_acceleration_noise = 0.03;  // m/s/sqrt(s)
  double levelled_tilt_sigma = 0.015;         // rad (0.9 deg)
  double cross_axis_sigma = 0.002;
  double unit_course_sigma = 0.02;  // rad (1 deg)

  // Levelling by the accelerometers.
  double tilt_sigma = 0.0175;             // rad (1 deg)
  double tilt_time = 3.0;                 // s
  double max_acceleration = 3.0;          // m/s^2
  double max_lateral_acceleration = 4.0;  // m/s^2

  // GNSS.
  double gnss_correlated = 0.7;
  double gnss_offset_time = 30.0;  // s
  double gnss_position_gate = 16.27;
  double gnss_velocity_gate = 16.27;
  int gnss_recover_after = 5;
  double gnss_recovery_sigma = 20.0;        // m
  double gnss_recovery_course_sigma = 0.3;  // rad
  double fix_hold = 3.0;                    // s
  double gnss_lever_forward = 0.0;          // m
  double gnss_lever_left = 0.0;             // m
  double gnss_lever_up = 0.0;               // m
  double gnss_lever_sigma = 0.2;            // m

  // Lasting contradictions (contradiction.h): for HEALTH, and for the weight of fixes.
  double doubt_memory = 10.0;  // s
  double doubt_gate = 25.0;
  double doubt_motion_gate = 15.0;
  double doubt_scatter = 3.0;

  // Map feedback.
  double map_position_gate = 10.83;
  double map_azimuth_gate = 6.63;
  int map_recover_after = 5;
  double map_recovery_sigma = 10.0;  // m
  double lane_length = 300.0;        // m
  double lane_lasting = 0.3;

  // Scale of the speed sensor.
  double speed_scale_sigma = 0.015;
  double speed_scale_walk = 0.001;  // 1/sqrt(s)

  // Lasting errors of a LiDAR.
  double lidar_scale_sigma = 0.002;
  double lidar_turn_sigma = 3.5e-5;  // rad/m (0.2 deg in 100 m)
  double lidar_error_time = 300.0;   // s

  // Wheels.
  double min_wheel_sigma = 0.02;  // m/s

  // Standing still.
  double still_force = 0.05;          // m/s^2
  double still_rate = 0.0052;         // rad/s (0.3 deg/s)
  double still_speed = 0.1;           // m/s
  double quiet_force = 0.08;          // m/s^2
  double quiet_rate = 0.004;          // rad/s (0.23 deg/s)
  double zero_velocity_sigma = 0.02;  // m/s
  double zero_rate_sigma = 1.7e-4;    // rad/s (0.01 deg/s)

  // Odometry.
  double min_speed_sigma = 0.05;       // m/s
  double min_rotation_sigma = 5.2e-4;  // rad (0.03 deg)
  double speed_gate = 10.83;
  double sideways_gate = 13.82;
  double rotation_gate = 16.27;
  double chained_azimuth_sigma = 0.0035;  // rad (0.2 deg)
  double chain_drift = 8.7e-5;            // rad/sqrt(m) (0.005 deg)
  int recover_after = 10;
  double recovery_speed_sigma = 5.0;      // m/s
  double recovery_rotation_sigma = 0.05;  // rad (3 deg)

  bool uses_six_axes() const {
    const bool no_speed_sensor = !use_odometry_speed && !use_wheel_speed;
    return inertial_axes == InertialAxes::six ||
           (inertial_axes == InertialAxes::automatic && no_speed_sensor);
  }
};

}  // namespace maploop::fusion
