// Writes the events of an LCM log as a bag of ROS 1: each unchanged, as maploop reads it back
// (sensors/replay/log_events.h), and what it shows (event_views.h) once more in ROS's messages.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"
#include "sensors/bag/ros1_bag_writer.h"
#include "tools/log/ros_types.h"

namespace maploop::lcm_log {

class BagLog {
 public:
  // `compression` is "none", "lz4" or "bz2". The schema must outlive this.
  BagLog(sensors::bag::Ros1BagWriter::Append append, std::string compression,
         const schema::Schema& schema)
      : writer_(std::move(append), std::move(compression)), schema_(schema) {}

  // Throws std::runtime_error for too many channels.
  void write(const LogEvent& event);

  // Ends the file. Returns the bytes that are then to replace those at its beginning.
  std::string close() { return writer_.close(); }

 private:
  std::uint32_t connection(std::string_view topic, const RosType& type);

  sensors::bag::Ros1BagWriter writer_;
  const schema::Schema& schema_;
  std::map<std::string, std::uint32_t, std::less<>> connections_;
};

}  // namespace maploop::lcm_log
