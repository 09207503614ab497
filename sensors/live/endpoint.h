// This file describes where a sensor is connected.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::sensors {

// The text forms are:
// udp://[ADDRESS]:PORT               listens there; without an address on the loopback only
// tcp://ADDRESS:PORT                 connects to this address
// serial:///dev/ttyUSB0[?baud=115200]
// Addresses are numeric IPv4, because the lookup of a name could block for long.
struct Endpoint {
  enum class Kind : std::uint8_t { udp, tcp, serial };
  Kind kind = Kind::udp;
  std::string address{};
  std::uint16_t port = 0;  // udp: 0 takes any free port
  std::string device{};
  int baud = 115200;
  std::string text{};  // as it was given
};

// Throws std::invalid_argument that names the text and states what is allowed.
Endpoint parse_endpoint(std::string_view text);

// Returns the text of a connection (an endpoint, an NTRIP mountpoint, a GStreamer pipeline) as it
// may be shown: *** replaces the user and password of its URL, and the value of the property
// user-pw.
std::string without_secrets(std::string_view text);

}  // namespace maploop::sensors
