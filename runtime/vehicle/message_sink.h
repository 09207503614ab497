// Where encoded messages go: the bus, a log, a hash.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "msgs/time.h"

namespace maploop::vehicle {

struct Message {
  std::string_view channel;
  Time time;                           // of the data: when it became available
  std::span<const std::uint8_t> data;  // LCM encoding
  bool from_data;                      // false for what speaks of this run: DEADLINES, HEALTH
};

// Called by the publisher thread only.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  virtual void send(const Message& message) = 0;
  // Whether it takes raw images and scans too, some 30 MB/s.
  virtual bool wants_raw() const { return false; }
};

}  // namespace maploop::vehicle
