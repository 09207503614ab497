// This file reads the clouds of points of ROS.
#pragma once

#include <cstddef>
#include <vector>

#include "msgs/lidar_scan.h"
#include "msgs/time.h"
#include "sensors/bag/ros_messages.h"

namespace maploop::sensors {

// Holds the finite points of a cloud.
struct TimedCloud {
  std::vector<LidarPoint> points;  // reflectance as in the message; 0 if it has none
  std::vector<Time> times;         // one a point; empty if the cloud has none
  std::size_t dropped = 0;         // points that are not finite
};

// Reads the fields x, y, z; intensity or reflectivity; and t, time, timestamp, time_offset, ts or
// offset_time: of any type, order and alignment. Times are since the stamp or since 1970; their
// unit is found (cloud/time_unit.h). Throws std::invalid_argument whose text is the reason: no
// field x, y or z, too few bytes, a field beyond its point, no finite point.
void read_cloud(const RosPointCloud& message, TimedCloud& cloud);

}  // namespace maploop::sensors
