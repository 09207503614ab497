// The newest message of each channel, for any number of browsers that each look at their own pace.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace maploop::dashboard {

// A browser that is slow misses messages in between, and never holds up anybody. For any threads.
class LiveChannels {
 public:
  struct Message {
    std::string channel;
    std::string json;
  };

  void put(const std::string& channel, std::string json);

  // What is newer than `seen`, which is then brought up to date; waits up to `at_most` for it.
  // Empty when nothing came, or after close().
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
