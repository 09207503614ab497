// Computes one hash per channel of everything sent on it: two runs with equal hashes sent the same
// bits.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/vehicle/output/message_sink.h"

namespace maploop::vehicle {

struct ChannelSummary {
  std::uint64_t count = 0;
  std::string hash;  // XXH3, 16 hexadecimal digits; empty for channels about the run
};

class ChannelHashes final : public MessageSink {
 public:
  // Only messages with a data time later than `after` are counted and hashed.
  explicit ChannelHashes(Time after = Time::min());
  ~ChannelHashes() override;

  std::string_view name() const override { return "hashes"; }
  // Must not be called while another thread sends.
  std::map<std::string, ChannelSummary> summary() const;

 private:
  bool take(const Message& message) override;

  struct Channel;
  Time after_;
  std::map<std::string, std::unique_ptr<Channel>, std::less<>> channels_;
};

}  // namespace maploop::vehicle
