// Which sensors of a live run are there, in a line.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>

#include "msgs/diagnostics.h"

namespace maploop::tools {

// For any threads.
class LiveStatus {
 public:
  void take(const Health& health);

  // "camera 10.0 Hz, velodyne absent, imu 99.8 Hz": samples of the last seconds; absent: none.
  // Empty before the first health.
  std::string text() const;

 private:
  struct Look {
    double elapsed = 0.0;                            // s
    std::map<std::string, std::uint64_t> delivered;  // samples since the start, by sensor
  };

  mutable std::mutex mutex_;
  std::deque<Look> looks_{Look{}};  // the oldest first
};

// Whether none of the live sensors has delivered a sample.
bool nothing_came(const Health& health);

}  // namespace maploop::tools
