// Messages on an LCM bus.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/vehicle/message_sink.h"

namespace lcm {
class LCM;
}

namespace maploop::vehicle {

// Where messages go: what the command line names, else what the configuration names, else the
// environment's LCM_DEFAULT_URL as for every LCM program, else LcmBus::default_url.
std::string bus_url(const std::string& named, const std::string& configured = {});

// Hands what has come to its subscribers, at most a hundred messages: whoever floods a channel does
// not stop the caller. Never waits.
void hear_waiting(lcm::LCM& lcm);

class LcmBus final : public MessageSink {
 public:
  // The default stays on this host (ttl=0). Throws std::runtime_error naming the URL when LCM
  // cannot open it. Asks for a larger send buffer, for which no other thread may open a UDP socket
  // meanwhile.
  static constexpr const char* default_url = "udpm://239.255.76.67:7667?ttl=0";
  explicit LcmBus(const std::string& url);
  ~LcmBus() override;

  std::string_view name() const override { return "LCM"; }
  bool wants_preview() const override { return true; }

  // For others to publish and subscribe on; LCM itself may be used by several threads.
  lcm::LCM& lcm();

  // What the kernel granted for a bus of this URL: "LCM: ..."; nothing where it is no udpm.
  const std::vector<RealtimeSetting>& settings() const { return settings_; }

 private:
  bool take(const Message& message) override;

  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string channel_;  // reused: LCM wants a terminated string
  std::vector<RealtimeSetting> settings_;
};

}  // namespace maploop::vehicle
