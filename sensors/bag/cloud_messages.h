// This file makes the turns of a spinning LiDAR from the clouds of points of ROS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/bag/ros_messages.h"
#include "sensors/velodyne/turn_assembler.h"

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

// Assembles turns from rear to rear (turn_assembler.h) of clouds that begin anywhere, by the times
// of their points. The scanner must turn clockwise, seen from above. One thread at a time.
class CloudTurns {
 public:
  explicit CloudTurns(Duration max_turn) : assembler_(max_turn) {}

  // Takes a cloud with times. Call next() until it returns false before the next cloud.
  void add(TimedCloud& cloud);
  bool next(LidarScan& scan);

  const TurnCounts& counts() const { return assembler_.counts(); }

 private:
  TurnAssembler assembler_;
  const TimedCloud* cloud_ = nullptr;
  std::vector<std::uint32_t> order_;
  std::size_t at_ = 0;
};

}  // namespace maploop::sensors
