// Publishes messages on an LCM bus.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/vehicle/output/message_sink.h"

namespace lcm {
class LCM;
}

namespace maploop::vehicle {

// Returns the URL of the bus: `named` of the command line, else `configured`, else LCM_DEFAULT_URL
// of the environment as for every LCM program, else LcmBus::default_url. An empty string is not a
// URL.
std::string bus_url(const std::string& named, const std::string& configured = {});

// Passes waiting messages to their subscribers, at most a hundred, so that a flooded channel does
// not hold up the caller. Never blocks.
void hear_waiting(lcm::LCM& lcm);

class LcmBus final : public MessageSink {
 public:
  // The default URL stays on this host (ttl=0). The constructor throws std::runtime_error naming
  // the URL if LCM cannot open it. It asks for a larger send buffer; no other thread may open a UDP
  // socket meanwhile, because the new socket is taken for LCM's.
  static constexpr const char* default_url = "udpm://239.255.76.67:7667?ttl=0";
  explicit LcmBus(const std::string& url);
  ~LcmBus() override;

  std::string_view name() const override { return "LCM"; }
  bool wants_preview() const override { return true; }

  // Other objects may publish and subscribe with this; several threads may use LCM at the same
  // time.
  lcm::LCM& lcm();

  // Returns what the kernel granted for the bus, as items named "LCM: ..."; empty if its URL is not
  // udpm.
  const std::vector<RealtimeSetting>& settings() const { return settings_; }

 private:
  bool take(const Message& message) override;

  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string channel_;  // a reused buffer: LCM needs a terminated string
  std::vector<RealtimeSetting> settings_;
};

}  // namespace maploop::vehicle
