#include "runtime/vehicle/output/lcm_bus.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

#include "runtime/core/realtime_text.h"
#include "runtime/vehicle/output/socket_buffers.h"

namespace maploop::vehicle {
namespace {

// With receive buffers of 2 MB LCM carried 30 of 30 messages of 1.4 MB; with the default ones it
// carried 0.
constexpr int buffer_bytes = 2 * 1024 * 1024;

}  // namespace

std::string bus_url(const std::string& named, const std::string& configured) {
  if (!named.empty()) return named;
  if (!configured.empty()) return configured;
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  return environment != nullptr && *environment != '\0' ? environment : LcmBus::default_url;
}

void hear_waiting(lcm::LCM& lcm) {
  constexpr int max_messages = 100;
  for (int i = 0; i < max_messages && lcm.handleTimeout(0) > 0; ++i) {
  }
}

struct LcmBus::Connection {
  explicit Connection(const std::string& url) : lcm(url) {}
  lcm::LCM lcm;
};

LcmBus::LcmBus(const std::string& url) {
  const std::vector<int> before = udp_sockets();
  connection_ = std::make_unique<Connection>(url);
  if (!connection_->lcm.good()) {
    throw std::runtime_error("LCM cannot open '" + url +
                             "': check the URL, and that this host has a multicast route (ip route "
                             "add 224.0.0.0/4 dev lo), or run with --no-lcm");
  }
  std::vector<int> opened;
  std::ranges::set_difference(udp_sockets(), before, std::back_inserter(opened));
  for (const int socket : opened) settings_.push_back(ask_for_send_buffer(socket, buffer_bytes));
  if (!opened.empty()) {
    settings_.push_back(assess_receive_buffers(
        runtime::read_system_file("/proc/sys/net/core/rmem_max"), buffer_bytes));
  }
}

LcmBus::~LcmBus() = default;

lcm::LCM& LcmBus::lcm() {
  return connection_->lcm;
}

bool LcmBus::take(const Message& message) {
  channel_ = message.channel;
  const auto size = static_cast<unsigned int>(message.data.size());
  return connection_->lcm.publish(channel_, message.data.data(), size) == 0;
}

}  // namespace maploop::vehicle
