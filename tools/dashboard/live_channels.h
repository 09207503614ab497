// Stores the newest message of each channel of each run for any number of browsers, each of which
// reads at its own pace.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
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

  static constexpr const char* all_runs = "";  // its messages are for every browser

  void put(const std::string& run, const std::string& channel, std::string json);
  void forget(const std::string& run);

  // Returns the messages of a run, and those for every browser, that are newer than `seen`, and
  // updates `seen`; waits up to `at_most` for one. Returns nothing if none arrived, or after
  // close().
  std::vector<Message> newer(const std::string& run, std::uint64_t& seen,
                             std::chrono::milliseconds at_most);

  // Ends all waiting.
  void close();
  bool closed() const;

 private:
  struct Entry {
    std::string json;
    std::uint64_t version = 0;
  };

  std::vector<Message> messages(const std::string& run, std::uint64_t after) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::pair<std::string, std::string>, Entry> channels_;  // by run and channel
  std::uint64_t version_ = 0;
  bool closed_ = false;
};

}  // namespace maploop::dashboard
