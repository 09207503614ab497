// Datagrams to one address.
#pragma once

#include <cstdint>
#include <span>

#include "sensors/live/endpoint.h"

namespace maploop::sensors {

// One thread at a time.
class DatagramSender {
 public:
  // Throws std::invalid_argument where the endpoint is not udp, std::runtime_error where there can
  // be no socket.
  explicit DatagramSender(const Endpoint& to);
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  // False where the system did not take it; that nobody listens is no error.
  bool send(std::span<const std::uint8_t> bytes) const;

 private:
  int fd_;
};

}  // namespace maploop::sensors
