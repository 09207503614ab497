// MessageTape keeps every message that contains data, and none about the run itself.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/vehicle/output/message_sink.h"

namespace maploop::testing {

class MessageTape final : public vehicle::MessageSink {
 public:
  struct Taped {
    Time time;
    std::vector<std::uint8_t> data;
    bool operator==(const Taped&) const = default;
  };
  using Channels = std::map<std::string, std::vector<Taped>>;

  std::string_view name() const override { return "tape"; }

  Channels all() const { return channels_; }

 private:
  bool take(const vehicle::Message& message) override {
    if (message.from_data) {
      channels_[std::string(message.channel)].push_back(
          {message.time, {message.data.begin(), message.data.end()}});
    }
    return true;
  }

  Channels channels_;
};

// Returns the messages later than t.
inline MessageTape::Channels after(const MessageTape::Channels& channels, Time t) {
  MessageTape::Channels later;
  for (const auto& [name, messages] : channels) {
    for (const MessageTape::Taped& message : messages) {
      if (message.time > t) later[name].push_back(message);
    }
  }
  return later;
}

}  // namespace maploop::testing
