// Passes messages of the bus on to Foxglove.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/lcm/log/log_event.h"
#include "tools/dashboard/foxglove_server.h"

namespace maploop::dashboard {

// The channels are those of an MCAP file of a log (tools/log/shown_event.h). A message that no
// viewer is subscribed to is not decoded, with two exceptions: one of each bus channel a second
// until its Foxglove channels are known, and one that follows no other within a second, such as a
// calibration, which is kept for viewers to come. For one thread.
class FoxgloveBridge {
 public:
  explicit FoxgloveBridge(FoxgloveServer& server) : server_(server) {}

  void take(const lcm_log::LogEvent& event);

 private:
  struct Known {
    std::set<int> channels;  // of the server
    bool complete = false, kept = false;
    std::int64_t last_us = 0, looked_at_us = 0;
  };
  bool is_wanted(const Known& known) const;

  FoxgloveServer& server_;
  std::map<std::pair<std::string, std::string>, int> channels_;  // by topic and schema
  std::map<std::string, Known, std::less<>> known_;              // by bus channel
};

}  // namespace maploop::dashboard
