// Stores the newest message of each channel for any number of browsers, each of which reads at its
// own pace.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace maploop::dashboard {

// A slow browser misses messages in between and never blocks any other thread. All functions may be
// called from any thread.
class LiveChannels {
 public:
  struct Message {
    std::string channel;
    std::string json;
  };

  void put(const std::string& channel, std::string json);

  // Returns the messages newer than `seen` and updates `seen`; waits up to `at_most` for one.
  // Returns nothing if none arrived, or after close().
  std::vector<Message> newer(std::uint64_t& seen, std::chrono::milliseconds at_most);

  // Ends all waiting.
  void close();
  bool closed() const;

 private:
  struct Entry {
    std::string json;
    std::uint64_t version = 0;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Entry> channels_;
  std::uint64_t version_ = 0;
  bool closed_ = false;
};

}  // namespace maploop::dashboard
