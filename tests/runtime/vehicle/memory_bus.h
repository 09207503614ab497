// MemoryBus keeps what is sent in memory, and refuses messages on demand.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/vehicle/output/message_sink.h"

namespace maploop::vehicle::testing {

class MemoryBus final : public MessageSink {
 public:
  struct Kept {
    std::string channel;
    Time time;
    std::vector<std::uint8_t> data;
  };

  // Takes `refused_from` messages and refuses all later ones; 0: takes all.
  explicit MemoryBus(std::uint64_t refused_from = 0) : refused_from_(refused_from) {}

  std::string_view name() const override { return "memory"; }

  // Must be called after the vehicle has ended.
  const std::vector<Kept>& messages() const { return messages_; }

  // Waits until `count` messages of a channel have come; returns false if they have not within a
  // minute.
  bool wait_for(std::string_view channel, std::size_t count) const {
    for (int i = 0; i < 6000; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (static_cast<std::size_t>(std::count_if(
                messages_.begin(), messages_.end(),
                [&](const Kept& kept) { return kept.channel == channel; })) >= count) {
          return true;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  // Returns every message of one channel, decoded. Throws std::runtime_error if one has another
  // type.
  template <class Lcm>
  std::vector<Lcm> decoded(std::string_view channel) const {
    std::vector<Lcm> all;
    for (const Kept& kept : messages_) {
      if (kept.channel != channel) continue;
      const int size = static_cast<int>(kept.data.size());
      if (all.emplace_back().decode(kept.data.data(), 0, size) != size) {
        throw std::runtime_error("a message of " + kept.channel + " does not decode");
      }
    }
    return all;
  }

 private:
  bool take(const Message& message) override {
    const std::lock_guard lock(mutex_);
    if (refused_from_ != 0 && messages_.size() == refused_from_) return false;
    messages_.push_back(
        {std::string(message.channel), message.time, {message.data.begin(), message.data.end()}});
    return true;
  }

  std::uint64_t refused_from_;
  mutable std::mutex mutex_;
  std::vector<Kept> messages_;
};

}  // namespace maploop::vehicle::testing
