// Converts what the vehicle sends to messages that Foxglove shows on its map and in its scene.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct FoxgloveMessage {
  std::string_view topic;
  std::string_view schema_name;
  std::string json;
};

// Calls use(message) for each message that shows what an event contains:
//   NAV_STATE    /map/fix LocationFix of the inertial unit, /map/pose PoseInFrame "map" (east,
//                north, up from the drive's origin), and /tf FrameTransform from "map" to "body"
//   ODOM_STATE   /odom/pose PoseInFrame "odom"
//   GNSS_FIX     /gnss/fix LocationFix
//   TRUTH        /truth/fix LocationFix
//   CALIBRATION  /tf_static FrameTransform from "body" to "cam" and to "velo"
//   CAMERA       /camera/left and /camera/right CompressedImage (JPEG)
//   VELODYNE     /velodyne PointCloud
// An event that is none of these, or that has no position yet, shows nothing.
void show_in_foxglove(const LogEvent& event, const schema::Schema& schema,
                      const std::function<void(const FoxgloveMessage&)>& use);

struct FoxgloveTopic {
  std::string_view name, schema_name;
};

// Returns the topics that show the events of a channel; none for most channels.
std::span<const FoxgloveTopic> foxglove_topics(std::string_view channel);

// Returns the JSON schema of one of these names.
std::string foxglove_schema(std::string_view schema_name);

}  // namespace maploop::lcm_log
