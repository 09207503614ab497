// Writes what an event shows in the messages of ROS 1.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tools/log/event_views.h"
#include "tools/log/ros_types.h"

namespace maploop::lcm_log {

// Returns the type in which a view is written: NavSatFix, Odometry, TFMessage, CompressedImage,
// PointCloud2, MarkerArray or Imu.
const RosType& ros_type(const View& view);

// Returns the message. Angular velocity and specific force that a reduced inertial unit does not
// measure are 0.
std::string ros_message(const View& view);

// Returns the message of the bytes of an LCM message.
std::string ros_bytes(std::span<const std::uint8_t> bytes);

}  // namespace maploop::lcm_log
