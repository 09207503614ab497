// From the bus to the browsers, and back.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/dashboard/live_channels.h"
#include "tools/dashboard/trail.h"

namespace maploop::dashboard {

// take() and pass_on() on one thread; trail() on any.
class Relay {
 public:
  // `channels` must outlive it.
  explicit Relay(LiveChannels& channels);

  // A message of any channel. Channels of whole images and scans, commands to the player and what
  // is no message of our types are left out; the latter are counted.
  void take(std::string_view channel, std::span<const std::uint8_t> data);

  // The newest message of each channel that had one since the last call.
  void pass_on();

  std::string trail() const;
  std::uint64_t not_understood() const { return not_understood_; }

 private:
  struct Waiting {
    std::vector<std::uint8_t> data;
    bool fresh = false;
  };

  LiveChannels& channels_;
  schema::Schema schema_;
  std::map<std::string, Waiting, std::less<>> waiting_;
  std::uint64_t not_understood_ = 0;
  mutable std::mutex trail_mutex_;
  Trail trail_;
};

// An encoded replay_control_t for a command by its name: pause, resume, step-sample, step-image,
// seek (s into the drive), speed, next-miss, quit. Empty where there is no such command.
std::vector<std::uint8_t> encoded_command(const std::string& kind, double value);

}  // namespace maploop::dashboard
