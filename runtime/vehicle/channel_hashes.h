// A hash of everything sent on each channel: two runs with equal hashes had the same bits.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/vehicle/message_sink.h"

namespace maploop::vehicle {

struct ChannelSummary {
  std::uint64_t count = 0;
  std::string hash;  // 16 hexadecimal digits (XXH3); empty for channels that speak of the run
};

class ChannelHashes final : public MessageSink {
 public:
  // Of the messages later than `after` (data time) only.
  explicit ChannelHashes(Time after = Time::min());
  ~ChannelHashes() override;

  std::string_view name() const override { return "hashes"; }
  std::map<std::string, ChannelSummary> summary() const;

 private:
  bool take(const Message& message) override;

  struct Channel;
  Time after_;
  std::map<std::string, std::unique_ptr<Channel>, std::less<>> channels_;
};

}  // namespace maploop::vehicle
