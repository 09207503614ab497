// This file names the parts of bags of ROS 1, version 2.0 (https://wiki.ros.org/Bags/Format/2.0),
// for their reader and their writer.
#pragma once

#include <cstdint>
#include <string_view>

namespace maploop::sensors::bag {

constexpr std::string_view ros1_bag_magic = "#ROSBAG V", ros1_bag_line = "#ROSBAG V2.0\n";

// These are the values of the field `op`.
namespace bag_op {
constexpr std::uint8_t message = 0x02, bag_header = 0x03, index_data = 0x04, chunk = 0x05,
                       chunk_info = 0x06, connection = 0x07;
}  // namespace bag_op

// The first field of the bag's own record in our own recordings (sensors/replay/log_events.h).
constexpr std::string_view ros1_own_field = "profile=maploop";

}  // namespace maploop::sensors::bag
