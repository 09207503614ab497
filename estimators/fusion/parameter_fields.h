// Every parameter by name: what a configuration file sets, and what an archive must agree with.
#pragma once

#include <concepts>
#include <type_traits>

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/guard_parameters.h"

namespace maploop::fusion {

// Calls f(name, member) for each; Parameters is FusionParameters, const or not.
template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, FusionParameters>
void fields(Parameters& p, F&& f) {
  f("use_gnss", p.use_gnss);
  f("use_odometry_speed", p.use_odometry_speed);
  f("use_odometry_azimuth", p.use_odometry_azimuth);
  f("chain_odometry_azimuth", p.chain_odometry_azimuth);
  f("use_wheel_speed", p.use_wheel_speed);
  f("use_zero_velocity", p.use_zero_velocity);
  f("history_length", p.history_length);
  f("history_capacity", p.history_capacity);
  f("confirm_gap", p.confirm_gap);
  f("max_gap", p.max_gap);
  f("max_stamp_ahead", p.max_stamp_ahead);
  f("restart_after", p.restart_after);
  f("max_step", p.max_step);
  f("imu_hold", p.imu_hold);
  f("repeat_speed", p.repeat_speed);
  f("imu_bridge", p.imu_bridge);
  f("coasting_after", p.coasting_after);
  f("max_interval", p.max_interval);
  f("max_origin_distance", p.max_origin_distance);
  f("min_course_speed", p.min_course_speed);
  f("max_stamp_offset", p.max_stamp_offset);
  f("min_position_sigma", p.min_position_sigma);
  f("min_velocity_sigma", p.min_velocity_sigma);
  f("start_course_sigma", p.start_course_sigma);
  f("start_slope_sigma", p.start_slope_sigma);
  f("start_roll_sigma", p.start_roll_sigma);
  f("start_acceleration", p.start_acceleration);
  f("gyro_noise", p.gyro_noise);
  f("gyro_turn_on_sigma", p.gyro_turn_on_sigma);
  f("gyro_bias_sigma", p.gyro_bias_sigma);
  f("gyro_bias_time", p.gyro_bias_time);
  f("gyro_scale_sigma", p.gyro_scale_sigma);
  f("turn_time", p.turn_time);
  f("acceleration_noise", p.acceleration_noise);
  f("accelerometer_turn_on_sigma", p.accelerometer_turn_on_sigma);
  f("accelerometer_bias_sigma", p.accelerometer_bias_sigma);
  f("accelerometer_bias_time", p.accelerometer_bias_time);
  f("yaw_acceleration", p.yaw_acceleration);
  f("jerk", p.jerk);
  f("silent_yaw_noise", p.silent_yaw_noise);
  f("silent_speed_noise", p.silent_speed_noise);
  f("max_specific_force", p.max_specific_force);
  f("max_yaw_rate", p.max_yaw_rate);
  f("pitch_noise", p.pitch_noise);
  f("roll_noise", p.roll_noise);
  f("rear_axle_distance", p.rear_axle_distance);
  f("slip_sigma", p.slip_sigma);
  f("slip_time", p.slip_time);
  f("climb_offset", p.climb_offset);
  f("climb_offset_sigma", p.climb_offset_sigma);
  f("climb_offset_time", p.climb_offset_time);
  f("climb_noise", p.climb_noise);
  f("max_tilt", p.max_tilt);
  f("tilt_sigma", p.tilt_sigma);
  f("tilt_time", p.tilt_time);
  f("max_acceleration", p.max_acceleration);
  f("max_lateral_acceleration", p.max_lateral_acceleration);
  f("gnss_correlated", p.gnss_correlated);
  f("gnss_offset_time", p.gnss_offset_time);
  f("gnss_position_gate", p.gnss_position_gate);
  f("gnss_velocity_gate", p.gnss_velocity_gate);
  f("gnss_recover_after", p.gnss_recover_after);
  f("gnss_recovery_sigma", p.gnss_recovery_sigma);
  f("fix_hold", p.fix_hold);
  f("gnss_lever_forward", p.gnss_lever_forward);
  f("gnss_lever_left", p.gnss_lever_left);
  f("gnss_lever_up", p.gnss_lever_up);
  f("map_position_gate", p.map_position_gate);
  f("map_azimuth_gate", p.map_azimuth_gate);
  f("map_recover_after", p.map_recover_after);
  f("map_recovery_sigma", p.map_recovery_sigma);
  f("lane_length", p.lane_length);
  f("lane_lasting", p.lane_lasting);
  f("speed_scale_sigma", p.speed_scale_sigma);
  f("speed_scale_walk", p.speed_scale_walk);
  f("lidar_scale_sigma", p.lidar_scale_sigma);
  f("lidar_turn_sigma", p.lidar_turn_sigma);
  f("lidar_error_time", p.lidar_error_time);
  f("min_wheel_sigma", p.min_wheel_sigma);
  f("still_force", p.still_force);
  f("still_rate", p.still_rate);
  f("still_speed", p.still_speed);
  f("zero_velocity_sigma", p.zero_velocity_sigma);
  f("zero_rate_sigma", p.zero_rate_sigma);
  f("min_speed_sigma", p.min_speed_sigma);
  f("min_rotation_sigma", p.min_rotation_sigma);
  f("speed_gate", p.speed_gate);
  f("rotation_gate", p.rotation_gate);
  f("chained_azimuth_sigma", p.chained_azimuth_sigma);
  f("chain_drift", p.chain_drift);
  f("recover_after", p.recover_after);
  f("recovery_speed_sigma", p.recovery_speed_sigma);
  f("recovery_rotation_sigma", p.recovery_rotation_sigma);
}

template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, GuardParameters>
void fields(Parameters& p, F&& f) {
  f("lifetime", p.lifetime);
  f("difference_gate", p.difference_gate);
  f("patience", p.patience);
  f("trusted", p.trusted);
  f("pause", p.pause);
  f("lost_azimuth", p.lost_azimuth);
  f("overconfidence", p.overconfidence);
  f("model_sigma", p.model_sigma);
  f("model_share", p.model_share);
}

}  // namespace maploop::fusion
