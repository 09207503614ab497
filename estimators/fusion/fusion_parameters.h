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
  six,        // the full unit: upward force, roll and pitch rate as well
};

constexpr auto names_of(InertialAxes) {
  return names_up_to<InertialAxes::six>({"auto", "three", "six"});
}

// Holds the parameters of ReducedImuFilter, whose constructor checks them. The gates bound the
// normalized innovation squared.
struct FusionParameters {
  // Which measurements correct the state. A named configuration (configuration.h) sets these.
  bool use_gnss = false;                // fixes, after the start, which always takes one
  bool use_odometry_speed = true;       // forward speed of odometry
  bool use_odometry_azimuth = true;     // rotation of odometry over each interval
  bool chain_odometry_azimuth = false;  // rotations added up to an azimuth of their own
  bool use_wheel_speed = false;         // speed of the wheels
  bool use_zero_velocity = true;        // zero velocity while the vehicle stands still
  bool still_by_inertia = false;        // quiet inertial samples alone show a standstill
  bool speed_from_turns = false;        // centripetal force of a turn corrects the speed
  InertialAxes inertial_axes = InertialAxes::automatic;  // used where a sample has six

  // History and time.
  double history_length = 3.0;        // s, age up to which late data is applied
  int history_capacity = 512;         // events at most
  double confirm_gap = 1.0;           // s
  double max_gap = 5.0;               // s
  double max_stamp_ahead = 0.05;      // s
  int restart_after = 100;            // refusals of stamps in a row; the clock has jumped
  double max_step = 0.05;             // s
  double imu_hold = 0.3;              // s
  double repeat_speed = 2.0;          // m/s
  double imu_bridge = 2.0;            // s
  double coasting_after = 1.0;        // s
  double max_interval = 1.0;          // s
  double max_origin_distance = 50e3;  // m

  // Start, from one GNSS fix.
  double min_course_speed = 2.0;           // m/s, from which a course starts the azimuth
  double max_course_velocity_sigma = 1.0;  // m/s, up to which it does
  double late_course_after = 10.0;         // s, after which a less certain velocity does, too
  double late_course_sigma = 0.25;         // rad, of such a course
  double max_stamp_offset = 0.2;           // s
  double min_position_sigma = 0.1;         // m
  double min_velocity_sigma = 0.03;        // m/s
  double start_course_sigma = 0.0087;      // rad (0.5 deg)
  double start_slope_sigma = 0.0087;       // rad (0.5 deg)
  double road_slope_sigma = 0.1;           // rad
  double start_roll_sigma = 0.035;         // rad (2 deg)
  double start_acceleration = 3.0;         // m/s^2

  // Inertial sensors.
  double gyro_noise = 8.7e-5;                 // rad/sqrt(s) (0.3 deg/sqrt(h)), angle random walk
  double gyro_turn_on_sigma = 1.75e-4;        // rad/s (36 deg/h)
  double gyro_bias_sigma = 4.8e-5;            // rad/s (10 deg/h)
  double gyro_bias_time = 300.0;              // s
  double gyro_scale_sigma = 0.003;            // share of the yaw rate; scale and cross-axis errors
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
  double pitch_noise = 0.0175;           // rad/sqrt(s) (1 deg), road and suspension
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
  double gnss_delay_sigma = 0.05;        // s; 0: the same
  double odometry_course_sigma = 0.035;  // rad (2 deg)
  double odometry_course_walk = 1e-4;    // rad/sqrt(s)
  double odometry_lever_sigma = 0.3;     // m
  double max_tilt = 0.8;                 // rad

  // A unit of six axes.
  double tilt_rate_noise = 1e-4;              // rad/sqrt(s) (0.3 deg/sqrt(h)), of pitch and roll
  double levelled_acceleration_noise = 0.03;  // m/s/sqrt(s)
  double levelled_tilt_sigma = 0.015;         // rad (0.9 deg)
  double cross_axis_sigma = 0.002;  // share of the yaw rate in the gyros of roll and pitch
  double unit_course_sigma = 0.02;  // rad (1 deg)

  // Levelling by the accelerometers.
  double tilt_sigma = 0.0175;             // rad (1 deg), of the roll seen in one sample
  double tilt_time = 3.0;                 // s
  double max_acceleration = 3.0;          // m/s^2
  double max_lateral_acceleration = 4.0;  // m/s^2

  // GNSS.
  double gnss_correlated = 0.7;             // share of a fix's variance that lasts
  double gnss_offset_time = 30.0;           // s
  double gnss_position_gate = 16.27;        // chi-square, 3 degrees of freedom
  double gnss_velocity_gate = 16.27;        // chi-square, 3 degrees of freedom
  int gnss_recover_after = 5;               // gated fixes in a row; twice as many start anew
  int gnss_recover_speed_after = 2;         // gated velocities in a row, by their length alone
  double gnss_recovery_sigma = 20.0;        // m
  double gnss_recovery_course_sigma = 0.3;  // rad
  double fix_hold = 3.0;                    // s
  double gnss_lever_forward = 0.0;          // m
  double gnss_lever_left = 0.0;             // m
  double gnss_lever_up = 0.0;               // m
  double gnss_lever_sigma = 0.2;            // m

  // Lasting contradictions (contradiction.h): for HEALTH, and for the weight of fixes.
  double doubt_memory = 10.0;       // s, over which contradictions are looked for
  double doubt_gate = 25.0;         // mean error of fixes or wheels, as chi-square
  double doubt_motion_gate = 15.0;  // the same of odometry's lengths and turns
  double doubt_scatter = 3.0;       // mean square of an aid's innovations to their variance

  // Map feedback.
  double map_position_gate = 10.83;  // across the road; chi-square, 1 degree of freedom
  double map_azimuth_gate = 6.63;    // chi-square, 1 degree of freedom
  int map_recover_after = 5;         // gated lines in a row, over 50 m
  double map_recovery_sigma = 10.0;  // m
  double lane_length = 300.0;        // m
  double lane_lasting = 0.3;         // share of the lane's error that persists after a turn

  // Scale of the speed sensor.
  double speed_scale_sigma = 0.015;  // of the scale at the start
  double speed_scale_walk = 0.001;   // 1/sqrt(s)

  // Lasting errors of a LiDAR.
  double lidar_scale_sigma = 0.002;  // of the range scale
  double lidar_turn_sigma = 3.5e-5;  // rad/m (0.2 deg in 100 m)
  double lidar_error_time = 300.0;   // s

  // Wheels.
  double min_wheel_sigma = 0.02;  // m/s, least one of the speed: slip

  // Standing still.
  double still_force = 0.05;          // m/s^2, sigma over a second below which it stands
  double still_rate = 0.0052;         // rad/s (0.3 deg/s)
  double still_speed = 0.1;           // m/s
  double quiet_force = 0.08;          // m/s^2
  double quiet_rate = 0.004;          // rad/s (0.23 deg/s)
  double zero_velocity_sigma = 0.02;  // m/s
  double zero_rate_sigma = 1.7e-4;    // rad/s (0.01 deg/s)

  // Odometry.
  double min_speed_sigma = 0.05;          // m/s, least one of the speed of odometry
  double min_rotation_sigma = 5.2e-4;     // rad (0.03 deg)
  double speed_gate = 10.83;              // of odometry and wheels; chi-square, 1 degree of freedom
  double sideways_gate = 13.82;           // across and up; chi-square, 2 degrees of freedom
  double rotation_gate = 16.27;           // chi-square, 3 degrees of freedom
  double chained_azimuth_sigma = 0.0035;  // rad (0.2 deg)
  double chain_drift = 8.7e-5;            // rad/sqrt(m) (0.005 deg)
  int recover_after = 10;                 // gated motions in a row, over 1 s
  double recovery_speed_sigma = 5.0;      // m/s
  double recovery_rotation_sigma = 0.05;  // rad (3 deg)

  // Returns whether the filter uses six axes, of samples that have them.
  bool uses_six_axes() const {
    const bool no_speed_sensor = !use_odometry_speed && !use_wheel_speed;
    return inertial_axes == InertialAxes::six ||
           (inertial_axes == InertialAxes::automatic && no_speed_sensor);
  }
};

}  // namespace maploop::fusion
