// This file defines the names of the channels for writers and readers.
#pragma once

#include <string_view>

namespace maploop::channel_names {

inline constexpr std::string_view nav_state = "NAV_STATE";
inline constexpr std::string_view odom_state = "ODOM_STATE";
inline constexpr std::string_view nav_protection = "NAV_PROTECTION";
inline constexpr std::string_view visual_odometry = "VO";
inline constexpr std::string_view lidar_odometry = "LIDAR_ODOMETRY";
inline constexpr std::string_view odometry = "ODOMETRY";
inline constexpr std::string_view map_match = "MAP_MATCH";
inline constexpr std::string_view map_doubt = "MAP_DOUBT";
inline constexpr std::string_view map_feedback = "MAP_FEEDBACK";
inline constexpr std::string_view imu = "IMU";
inline constexpr std::string_view gnss_fix = "GNSS_FIX";
inline constexpr std::string_view ppp_state = "PPP_STATE";
inline constexpr std::string_view wheel_speed = "WHEEL_SPEED";
inline constexpr std::string_view truth = "TRUTH";
inline constexpr std::string_view camera = "CAMERA";
inline constexpr std::string_view velodyne = "VELODYNE";
inline constexpr std::string_view preview = "PREVIEW";
inline constexpr std::string_view calibration = "CALIBRATION";
inline constexpr std::string_view replay_control = "REPLAY_CONTROL";
inline constexpr std::string_view run = "RUN";
inline constexpr std::string_view deadlines = "DEADLINES";
inline constexpr std::string_view self_calibration = "SELF_CALIBRATION";
inline constexpr std::string_view health = "HEALTH";
inline constexpr std::string_view snapshot = "SNAPSHOT";  // in black boxes: a snapshot's file

}  // namespace maploop::channel_names
