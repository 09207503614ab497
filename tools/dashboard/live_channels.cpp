#include "tools/dashboard/live_channels.h"

#include <utility>

namespace maploop::dashboard {

void LiveChannels::put(const std::string& run, const std::string& channel, std::string json) {
  {
    const std::lock_guard lock(mutex_);
    channels_[{run, channel}] = {std::move(json), ++version_};
  }
  changed_.notify_all();
}

void LiveChannels::forget(const std::string& run) {
  const std::lock_guard lock(mutex_);
  std::erase_if(channels_, [&](const auto& entry) { return entry.first.first == run; });
}

std::vector<LiveChannels::Message> LiveChannels::messages(const std::string& run,
                                                          std::uint64_t after) const {
  std::vector<Message> messages;
  for (const auto& [name, entry] : channels_) {
    const auto& [of, channel] = name;
    if ((of == run || of == all_runs) && entry.version > after)
      messages.push_back({channel, entry.json});
  }
  return messages;
}

std::vector<LiveChannels::Message> LiveChannels::newer(const std::string& run, std::uint64_t& seen,
                                                       std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  std::vector<Message> found;
  changed_.wait_for(lock, at_most, [&] {
    if (!closed_) found = messages(run, seen);
    return closed_ || !found.empty();
  });
  seen = version_;
  return found;
}

void LiveChannels::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

bool LiveChannels::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace maploop::dashboard
