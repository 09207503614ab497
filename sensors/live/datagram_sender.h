// This file sends datagrams to one address.
#pragma once

#include <cstdint>
#include <span>

#include "sensors/live/endpoint.h"

namespace maploop::sensors {

// One thread at a time may use a sender.
class DatagramSender {
 public:
  // Throws std::invalid_argument if the endpoint is not udp, and std::runtime_error if no socket
  // can be made.
  explicit DatagramSender(const Endpoint& to);
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  // Returns false if the system did not accept the datagram; a missing listener is not an error.
  bool send(std::span<const std::uint8_t> bytes) const;

 private:
  int fd_;
};

}  // namespace maploop::sensors
