// Messages on an LCM bus.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "runtime/vehicle/message_sink.h"

namespace lcm {
class LCM;
}

namespace maploop::vehicle {

class LcmBus final : public MessageSink {
 public:
  // The default stays on this host (ttl=0). Throws std::runtime_error naming the URL when LCM
  // cannot open it.
  static constexpr const char* default_url = "udpm://239.255.76.67:7667?ttl=0";
  explicit LcmBus(const std::string& url);
  ~LcmBus() override;

  void send(const Message& message) override;
  // For others to publish and subscribe on; LCM itself may be used by several threads.
  lcm::LCM& lcm();
  std::uint64_t failures() const { return failures_; }

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string channel_;  // reused: LCM wants a terminated string
  std::uint64_t failures_ = 0;
};

}  // namespace maploop::vehicle
