#include "tools/dashboard/live_channels.h"

#include <utility>

namespace maploop::dashboard {

void LiveChannels::put(const std::string& channel, std::string json) {
  {
    const std::lock_guard lock(mutex_);
    channels_[channel] = {std::move(json), ++version_};
  }
  changed_.notify_all();
}

std::vector<LiveChannels::Message> LiveChannels::newer(std::uint64_t& seen,
                                                       std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, at_most, [&] { return closed_ || version_ > seen; });
  std::vector<Message> messages;
  if (closed_) return messages;
  for (const auto& [channel, entry] : channels_) {
    if (entry.version > seen) messages.push_back({channel, entry.json});
  }
  seen = version_;
  return messages;
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
