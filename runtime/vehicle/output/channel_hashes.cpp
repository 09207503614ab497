#include "runtime/vehicle/output/channel_hashes.h"

#include <fmt/format.h>

#include <new>

#include "msgs/xxh3.h"

namespace maploop::vehicle {

struct ChannelHashes::Channel {
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  Channel() : state(XXH3_createState()) {
    if (state == nullptr) throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
  }
  std::unique_ptr<XXH3_state_t, Free> state;
  std::uint64_t count = 0;
  bool hashed = false;
};

ChannelHashes::ChannelHashes(Time after) : after_(after) {}
ChannelHashes::~ChannelHashes() = default;

bool ChannelHashes::take(const Message& message) {
  if (message.time <= after_) return true;
  auto found = channels_.find(message.channel);
  if (found == channels_.end()) {
    found = channels_.emplace(message.channel, std::make_unique<Channel>()).first;
  }
  Channel& channel = *found->second;
  ++channel.count;
  if (!message.from_data) return true;
  channel.hashed = true;
  XXH3_64bits_update(channel.state.get(), message.data.data(), message.data.size());
  return true;
}

std::map<std::string, ChannelSummary> ChannelHashes::summary() const {
  std::map<std::string, ChannelSummary> all;
  for (const auto& [name, channel] : channels_) {
    ChannelSummary& s = all[name];
    s.count = channel->count;
    if (channel->hashed) s.hash = fmt::format("{:016x}", XXH3_64bits_digest(channel->state.get()));
  }
  return all;
}

}  // namespace maploop::vehicle
