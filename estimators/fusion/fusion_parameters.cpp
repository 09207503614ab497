#include "estimators/fusion/fusion_parameters.h"

#include <stdexcept>
#include <string>

namespace maploop::fusion {
namespace {

void require(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;  // false for a NaN too
  throw std::invalid_argument("fusion parameter " + std::string(name) + " = " +
                              std::to_string(value) + " must lie in [" + std::to_string(low) +
                              ", " + std::to_string(high) + "]");
}

}  // namespace

void check(const FusionParameters& p) {
  constexpr double tiny = 1e-9;
  constexpr double huge = 1e6;
  require("history_length", p.history_length, 0.01, 60.0);
  require("history_capacity", p.history_capacity, 8, 100'000);
  require("confirm_gap", p.confirm_gap, 0.01, p.history_length);
  require("max_gap", p.max_gap, p.confirm_gap, 60.0);
  require("max_stamp_ahead", p.max_stamp_ahead, 0.0, p.confirm_gap);
  require("restart_after", p.restart_after, 2, huge);
  require("max_step", p.max_step, 1e-3, 1.0);
  require("imu_hold", p.imu_hold, 0.0, p.history_length);
  require("imu_bridge", p.imu_bridge, p.imu_hold, p.history_length);
  require("repeat_speed", p.repeat_speed, 0.0, huge);
  require("coasting_after", p.coasting_after, 0.0, huge);
  require("max_interval", p.max_interval, 1e-3, p.max_gap);
  require("max_origin_distance", p.max_origin_distance, 0.0, 1e5);

  require("min_course_speed", p.min_course_speed, 0.1, huge);
  require("max_stamp_offset", p.max_stamp_offset, 0.0, 2.0);
  require("min_position_sigma", p.min_position_sigma, tiny, huge);
  require("min_velocity_sigma", p.min_velocity_sigma, tiny, huge);
  require("start_course_sigma", p.start_course_sigma, tiny, 1.0);
  require("start_slope_sigma", p.start_slope_sigma, tiny, 1.0);
  require("start_roll_sigma", p.start_roll_sigma, tiny, 1.0);
  require("start_acceleration", p.start_acceleration, 0.0, huge);

  require("gyro_noise", p.gyro_noise, tiny, 1.0);
  require("gyro_turn_on_sigma", p.gyro_turn_on_sigma, tiny, 1.0);
  require("gyro_bias_sigma", p.gyro_bias_sigma, tiny, 1.0);
  require("gyro_bias_time", p.gyro_bias_time, 1.0, huge);
  require("gyro_scale_sigma", p.gyro_scale_sigma, 0.0, 1.0);
  require("turn_time", p.turn_time, 0.0, huge);
  require("acceleration_noise", p.acceleration_noise, tiny, huge);
  require("accelerometer_turn_on_sigma", p.accelerometer_turn_on_sigma, tiny, 10.0);
  require("accelerometer_bias_sigma", p.accelerometer_bias_sigma, tiny, 10.0);
  require("accelerometer_bias_time", p.accelerometer_bias_time, 1.0, huge);
  require("yaw_acceleration", p.yaw_acceleration, 0.0, 10.0);
  require("jerk", p.jerk, 0.0, 100.0);
  require("silent_yaw_noise", p.silent_yaw_noise, tiny, 10.0);
  require("silent_speed_noise", p.silent_speed_noise, tiny, 100.0);
  require("max_specific_force", p.max_specific_force, 10.0, huge);
  require("max_yaw_rate", p.max_yaw_rate, 0.1, huge);

  require("pitch_noise", p.pitch_noise, tiny, 1.0);
  require("roll_noise", p.roll_noise, tiny, 1.0);
  require("climb_offset", p.climb_offset, -1.0, 1.0);
  require("climb_offset_sigma", p.climb_offset_sigma, tiny, 1.0);
  require("climb_offset_time", p.climb_offset_time, 1.0, huge);
  require("climb_noise", p.climb_noise, tiny, 1.0);
  require("rear_axle_distance", p.rear_axle_distance, -5.0, 5.0);
  require("slip_sigma", p.slip_sigma, tiny, 1.0);
  require("slip_time", p.slip_time, 0.0, huge);
  require("max_tilt", p.max_tilt, 0.1, 1.5);

  require("tilt_sigma", p.tilt_sigma, tiny, 1.0);
  require("tilt_time", p.tilt_time, 0.0, huge);
  require("max_acceleration", p.max_acceleration, 0.0, huge);
  require("max_lateral_acceleration", p.max_lateral_acceleration, 0.0, huge);

  require("gnss_correlated", p.gnss_correlated, 0.0, 0.99);
  require("gnss_offset_time", p.gnss_offset_time, 0.1, huge);
  require("gnss_position_gate", p.gnss_position_gate, tiny, huge);
  require("gnss_velocity_gate", p.gnss_velocity_gate, tiny, huge);
  require("gnss_recover_after", p.gnss_recover_after, 1, huge);
  require("gnss_recovery_sigma", p.gnss_recovery_sigma, tiny, huge);
  require("fix_hold", p.fix_hold, 0.0, huge);
  require("gnss_lever_forward", p.gnss_lever_forward, -50.0, 50.0);
  require("gnss_lever_left", p.gnss_lever_left, -50.0, 50.0);
  require("gnss_lever_up", p.gnss_lever_up, -50.0, 50.0);

  require("map_position_gate", p.map_position_gate, tiny, huge);
  require("map_azimuth_gate", p.map_azimuth_gate, tiny, huge);
  require("map_recover_after", p.map_recover_after, 1, huge);
  require("map_recovery_sigma", p.map_recovery_sigma, 0.0, huge);
  require("lane_length", p.lane_length, 1.0, huge);
  require("lane_lasting", p.lane_lasting, 0.0, 1.0);

  require("speed_scale_sigma", p.speed_scale_sigma, tiny, 1.0);
  require("speed_scale_walk", p.speed_scale_walk, 0.0, 1.0);
  require("lidar_scale_sigma", p.lidar_scale_sigma, 0.0, 1.0);
  require("lidar_turn_sigma", p.lidar_turn_sigma, 0.0, 1.0);
  require("lidar_error_time", p.lidar_error_time, 1.0, huge);
  require("min_wheel_sigma", p.min_wheel_sigma, tiny, huge);

  require("still_force", p.still_force, 0.0, huge);
  require("still_rate", p.still_rate, 0.0, huge);
  require("still_speed", p.still_speed, 0.0, huge);
  require("zero_velocity_sigma", p.zero_velocity_sigma, tiny, huge);
  require("zero_rate_sigma", p.zero_rate_sigma, tiny, 1.0);

  require("chained_azimuth_sigma", p.chained_azimuth_sigma, tiny, 1.0);
  require("chain_drift", p.chain_drift, tiny, 1.0);
  require("min_speed_sigma", p.min_speed_sigma, tiny, huge);
  require("min_rotation_sigma", p.min_rotation_sigma, tiny, 1.0);
  require("speed_gate", p.speed_gate, tiny, huge);
  require("rotation_gate", p.rotation_gate, tiny, huge);
  require("recover_after", p.recover_after, 1, huge);
  require("recovery_speed_sigma", p.recovery_speed_sigma, tiny, huge);
  require("recovery_rotation_sigma", p.recovery_rotation_sigma, tiny, 1.0);
}

}  // namespace maploop::fusion
