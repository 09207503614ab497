// Where a sensor is connected.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::sensors {

// udp://[ADDRESS]:PORT               listens there; without an address on the loopback alone
// tcp://ADDRESS:PORT                 connects to there
// serial:///dev/ttyUSB0[?baud=115200]
// Addresses are numeric IPv4: a name would have to be asked for, and could be long in coming.
struct Endpoint {
  enum class Kind : std::uint8_t { udp, tcp, serial };
  Kind kind = Kind::udp;
  std::string address{};
  std::uint16_t port = 0;  // udp: 0 takes any free one
  std::string device{};
  int baud = 115200;
  std::string text{};  // as it was given
};

// Throws std::invalid_argument naming the text and what is allowed.
Endpoint parse_endpoint(std::string_view text);

// What may be shown of a text that names where a sensor is (an endpoint, an NTRIP mountpoint, a
// GStreamer pipeline): *** stands for the user and password of its URL, and for the value of the
// property user-pw.
std::string without_secrets(std::string_view text);

}  // namespace maploop::sensors
