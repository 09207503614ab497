// Every parameter by name: what the configuration file can set. The TOML key is the member's name.
#pragma once

#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

// Calls table(name) at the begin of each table, and field(key, member) for each of its keys. Config
// is VehicleConfig, const or not.
template <class Config, class Table, class Field>
void visit(Config& config, Table&& table, Field&& field) {
  field("lcm_url", config.lcm_url);

  table("scheduling");
  {
    auto& p = config.scheduling;
    field("camera", p.camera);
    field("velodyne", p.velodyne);
    field("imu", p.imu);
    field("gnss", p.gnss);
    field("reference", p.reference);
    field("stereo", p.stereo);
    field("fusion", p.fusion);
    field("publisher", p.publisher);
    field("health", p.health);
  }

  table("memory");
  {
    auto& p = config.memory;
    field("lock_memory", p.lock_memory);
    field("heap_mb", p.heap_mb);
    field("malloc_arenas", p.malloc_arenas);
  }

  table("trace");
  field("events_per_thread", config.trace.events_per_thread);

  table("replay");
  {
    auto& p = config.replay;
    field("imu_delay", p.imu_delay);
    field("camera_readout", p.camera_readout);
    field("max_pair_skew", p.max_pair_skew);
    field("max_turn", p.max_turn);
  }

  table("gnss");
  {
    auto& p = config.gnss;
    field("rate", p.rate);
    field("white_position", p.white_position);
    field("markov_position", p.markov_position);
    field("markov_time", p.markov_time);
    field("white_velocity", p.white_velocity);
    field("seed", p.seed);
  }

  table("stereo");
  {
    auto& p = config.stereo;
    field("bucket_size", p.bucket_size);
    field("features_per_bucket", p.features_per_bucket);
    field("fast_threshold", p.fast_threshold);
    field("min_corner_response", p.min_corner_response);
    field("min_feature_distance", p.min_feature_distance);
    field("window", p.window);
    field("pyramid_levels", p.pyramid_levels);
    field("predicted_levels", p.predicted_levels);
    field("max_iterations", p.max_iterations);
    field("min_step", p.min_step);
    field("min_disparity", p.min_disparity);
    field("max_disparity", p.max_disparity);
    field("min_correlation", p.min_correlation);
    field("max_row_error", p.max_row_error);
    field("max_closure", p.max_closure);
    field("sigma_track", p.sigma_track);
    field("sigma_disparity", p.sigma_disparity);
    field("sigma_match", p.sigma_match);
    field("correlated_pairs", p.correlated_pairs);
    field("sigma_disparity_offset", p.sigma_disparity_offset);
    field("disparity_offset_drift", p.disparity_offset_drift);
    field("max_offset_sigma", p.max_offset_sigma);
    field("min_offset_inliers", p.min_offset_inliers);
    field("min_tracks", p.min_tracks);
    field("min_inliers", p.min_inliers);
    field("min_inlier_ratio", p.min_inlier_ratio);
    field("ransac_threshold", p.ransac_threshold);
    field("ransac_confidence", p.ransac_confidence);
    field("ransac_max_hypotheses", p.ransac_max_hypotheses);
    field("huber", p.huber);
    field("outlier_sigmas", p.outlier_sigmas);
    field("refine_max_iterations", p.refine_max_iterations);
    field("window_frames", p.window_frames);
    field("window_max_points", p.window_max_points);
    field("window_iterations", p.window_iterations);
    field("window_min_flow", p.window_min_flow);
    field("sigma_acceleration", p.sigma_acceleration);
    field("sigma_turn_acceleration", p.sigma_turn_acceleration);
    field("max_speed", p.max_speed);
    field("max_acceleration", p.max_acceleration);
    field("max_yaw_rate", p.max_yaw_rate);
    field("max_turn_acceleration", p.max_turn_acceleration);
    field("max_gap", p.max_gap);
    field("max_stale_pairs", p.max_stale_pairs);
  }

  table("fusion");
  {
    auto& p = config.fusion;
    field("history_length", p.history_length);
    field("history_capacity", p.history_capacity);
    field("confirm_gap", p.confirm_gap);
    field("max_gap", p.max_gap);
    field("max_stamp_ahead", p.max_stamp_ahead);
    field("restart_after", p.restart_after);
    field("max_step", p.max_step);
    field("imu_hold", p.imu_hold);
    field("coasting_after", p.coasting_after);
    field("max_interval", p.max_interval);
    field("max_origin_distance", p.max_origin_distance);
    field("min_course_speed", p.min_course_speed);
    field("max_stamp_offset", p.max_stamp_offset);
    field("min_position_sigma", p.min_position_sigma);
    field("min_velocity_sigma", p.min_velocity_sigma);
    field("start_course_sigma", p.start_course_sigma);
    field("start_slope_sigma", p.start_slope_sigma);
    field("start_roll_sigma", p.start_roll_sigma);
    field("start_acceleration", p.start_acceleration);
    field("gyro_noise", p.gyro_noise);
    field("gyro_bias_sigma", p.gyro_bias_sigma);
    field("gyro_bias_time", p.gyro_bias_time);
    field("gyro_scale_sigma", p.gyro_scale_sigma);
    field("turn_time", p.turn_time);
    field("acceleration_noise", p.acceleration_noise);
    field("accelerometer_bias_sigma", p.accelerometer_bias_sigma);
    field("accelerometer_bias_time", p.accelerometer_bias_time);
    field("yaw_acceleration", p.yaw_acceleration);
    field("jerk", p.jerk);
    field("silent_yaw_noise", p.silent_yaw_noise);
    field("silent_speed_noise", p.silent_speed_noise);
    field("max_specific_force", p.max_specific_force);
    field("max_yaw_rate", p.max_yaw_rate);
    field("pitch_noise", p.pitch_noise);
    field("roll_noise", p.roll_noise);
    field("slip_sigma", p.slip_sigma);
    field("slip_time", p.slip_time);
    field("climb_offset", p.climb_offset);
    field("climb_offset_sigma", p.climb_offset_sigma);
    field("climb_offset_time", p.climb_offset_time);
    field("climb_noise", p.climb_noise);
    field("max_tilt", p.max_tilt);
    field("tilt_sigma", p.tilt_sigma);
    field("tilt_time", p.tilt_time);
    field("max_acceleration", p.max_acceleration);
    field("max_lateral_acceleration", p.max_lateral_acceleration);
    field("min_speed_sigma", p.min_speed_sigma);
    field("min_rotation_sigma", p.min_rotation_sigma);
    field("odometry_scale_sigma", p.odometry_scale_sigma);
    field("odometry_scale_time", p.odometry_scale_time);
    field("speed_gate", p.speed_gate);
    field("rotation_gate", p.rotation_gate);
    field("recover_after", p.recover_after);
    field("recovery_speed_sigma", p.recovery_speed_sigma);
    field("recovery_rotation_sigma", p.recovery_rotation_sigma);
  }
}

}  // namespace maploop::vehicle
