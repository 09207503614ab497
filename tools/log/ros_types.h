// The types of ROS 1 that bags are written with.
#pragma once

#include <string_view>

namespace maploop::lcm_log {

// The definition is that of ROS's packages without comments, followed by those that it uses. Its
// md5 is as ROS computes it.
struct RosType {
  std::string_view name, md5, definition;
};

// The bytes of an LCM message (sensors/replay/log_events.h).
extern const RosType lcm_message_type;

extern const RosType nav_sat_fix_type, odometry_type, transforms_type, compressed_image_type,
    point_cloud_type, markers_type, imu_type;

}  // namespace maploop::lcm_log
