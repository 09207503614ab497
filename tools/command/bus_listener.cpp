#include "tools/command/bus_listener.h"

#include <cerrno>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <utility>

namespace maploop::tools {
namespace {

[[noreturn]] void refuse(const std::string& url) {
  throw std::runtime_error("LCM cannot listen at '" + url +
                           "': check the URL (udpm://239.255.76.67:7667?ttl=0), and that this host "
                           "has a multicast route (ip link set lo up multicast on; ip route add "
                           "224.0.0.0/4 dev lo)");
}

}  // namespace

struct BusListener::Connection {
  Connection(const std::string& url, Handler to) : lcm(url), handler(std::move(to)) {}

  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (channel == "LCM_SELF_TEST")
      return;  // by which the library of each new listener tries itself
    handler(channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  }

  lcm::LCM lcm;
  Handler handler;
};

BusListener::BusListener(const std::string& url, const std::string& channels, Handler handler)
    : connection_(std::make_unique<Connection>(url, std::move(handler))) {
  if (!connection_->lcm.good()) refuse(url);
  lcm::Subscription* subscription =
      connection_->lcm.subscribe(channels, &Connection::hear, connection_.get());
  if (subscription == nullptr || connection_->lcm.getFileno() < 0) refuse(url);
  subscription->setQueueCapacity(10'000);  // more than a second of any of our channels
}

BusListener::~BusListener() = default;

bool BusListener::publish(const std::string& channel, std::span<const std::uint8_t> data) {
  return connection_->lcm.publish(channel, data.data(), static_cast<unsigned>(data.size())) == 0;
}

void BusListener::listen(int milliseconds) {
  errno = 0;
  if (connection_->lcm.handleTimeout(milliseconds) < 0) {
    if (errno == EINTR) return;  // a signal, which the caller has noted
    throw std::runtime_error("LCM has failed to receive; its own message is above");
  }
  constexpr int at_most = 1000;  // so that the caller comes to its other work
  for (int i = 0; i < at_most && connection_->lcm.handleTimeout(0) > 0; ++i) {
  }
}

}  // namespace maploop::tools
