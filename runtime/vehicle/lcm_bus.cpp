#include "runtime/vehicle/lcm_bus.h"

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace maploop::vehicle {

struct LcmBus::Connection {
  explicit Connection(const std::string& url) : lcm(url) {}
  lcm::LCM lcm;
};

LcmBus::LcmBus(const std::string& url) : connection_(std::make_unique<Connection>(url)) {
  if (!connection_->lcm.good()) {
    throw std::runtime_error("LCM cannot open '" + url +
                             "': check the URL, and that this host has a multicast route (ip route "
                             "add 224.0.0.0/4 dev lo), or run with --no-lcm");
  }
}

LcmBus::~LcmBus() = default;

lcm::LCM& LcmBus::lcm() {
  return connection_->lcm;
}

void LcmBus::send(const Message& message) {
  channel_ = message.channel;
  const auto size = static_cast<unsigned int>(message.data.size());
  if (connection_->lcm.publish(channel_, message.data.data(), size) != 0) ++failures_;
}

}  // namespace maploop::vehicle
