// This file reads the messages that a vehicle's run recorded: an LCM log, or the same messages in
// an MCAP file or a bag of ROS 1.
//
// Such a file names the profile "maploop". Each LCM channel is a topic: its name behind
// `lcm_topics`. In an MCAP file it is of encoding `lcm_encoding`, without a schema, for the
// messages state their type themselves (msgs/lcm); in a bag it is of type `lcm_ros_type`, whose
// only field are the bytes. Other topics repeat them for viewers, and are not read here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/log/log_reader.h"
#include "msgs/lcm/schema.h"

namespace maploop::sensors {

constexpr std::string_view lcm_topics = "/lcm/", lcm_encoding = "lcm",
                           lcm_ros_type = "maploop/LcmMessage";

// Used as LogReader is. Events come in the order in which they were recorded, those of an MCAP file
// or a bag numbered from 0; its damage has a place, but no length.
class LogEvents {
 public:
  using Item = lcm_log::LogReader::Item;

  LogEvents() = default;
  virtual ~LogEvents() = default;
  LogEvents(const LogEvents&) = delete;
  LogEvents& operator=(const LogEvents&) = delete;

  virtual Item next() = 0;

  // These belong to the last next() that returned event or damage; valid until the next call.
  virtual const lcm_log::LogEvent& event() const = 0;
  virtual const lcm_log::Damage& damage() const = 0;

  virtual std::uint64_t position() const = 0;  // bytes read, uncompressed

  // These are sizes of the file on disk, in bytes, for a progress line; 0: not known.
  virtual std::uint64_t file_size() const = 0;
  virtual std::uint64_t file_position() const = 0;
};

// Returns whether the file is an MCAP file or a bag of the profile above, also compressed. Does not
// throw.
bool is_own_recording(const std::filesystem::path& file);

// Opens any of them; what is none is an LCM log that is all damage. The schema must outlive the
// result. From an MCAP file or a bag only events of `channel` are read, unless it is empty. Throws
// std::runtime_error that names the file if it cannot be opened.
std::unique_ptr<LogEvents> open_log(const std::filesystem::path& file, const schema::Schema& schema,
                                    std::string_view channel = {});

}  // namespace maploop::sensors
