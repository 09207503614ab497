#include "sensors/live/endpoint.h"

#include <arpa/inet.h>

#include <algorithm>
#include <stdexcept>

#include "sensors/live/serial_port.h"
#include "sensors/number.h"

namespace maploop::sensors {
namespace {

[[noreturn]] void reject(std::string_view text, const std::string& why) {
  throw std::invalid_argument("'" + without_secrets(text) +
                              "' is not an endpoint of a sensor: " + why +
                              "; expected udp://[ADDRESS]:PORT, tcp://ADDRESS:PORT or "
                              "serial:///dev/NAME?baud=115200");
}

Endpoint serial(std::string_view text, std::string_view rest) {
  constexpr std::string_view key = "?baud=";
  Endpoint endpoint{.kind = Endpoint::Kind::serial, .text = std::string(text)};
  const std::size_t question = rest.find('?');
  endpoint.device = rest.substr(0, question);
  if (question != std::string_view::npos) {
    const std::string_view query = rest.substr(question);
    const auto baud = parse_number<int>(query.substr(std::min(query.size(), key.size())));
    if (!query.starts_with(key) || !baud) reject(text, "only ?baud=NUMBER may follow the device");
    endpoint.baud = *baud;
  }
  if (!endpoint.device.starts_with("/")) reject(text, "the device is not an absolute path");
  if (!is_baud_rate(endpoint.baud)) {
    reject(text, std::to_string(endpoint.baud) + " baud is not a standard rate of serial lines");
  }
  return endpoint;
}

}  // namespace

Endpoint parse_endpoint(std::string_view text) {
  const std::size_t scheme = text.find("://");
  if (scheme == std::string_view::npos)
    reject(text, "it does not start with udp://, tcp:// or serial:");
  const std::string_view kind = text.substr(0, scheme), rest = text.substr(scheme + 3);
  if (kind == "serial") return serial(text, rest);
  if (kind != "udp" && kind != "tcp") reject(text, "its kind is unknown");
  Endpoint endpoint{.kind = kind == "udp" ? Endpoint::Kind::udp : Endpoint::Kind::tcp,
                    .text = std::string(text)};
  const std::size_t colon = rest.rfind(':');
  const auto port = colon != std::string_view::npos
                        ? parse_number<std::uint16_t>(rest.substr(colon + 1))
                        : std::nullopt;
  if (!port) reject(text, "it has no port from 0 to 65535");
  endpoint.port = *port;
  endpoint.address = rest.substr(0, colon);
  if (endpoint.kind == Endpoint::Kind::udp && endpoint.address.empty()) {
    endpoint.address = "127.0.0.1";
  }
  in_addr ignored{};
  if (inet_pton(AF_INET, endpoint.address.c_str(), &ignored) != 1) {
    reject(text, "its address is not numeric such as 192.168.1.201");
  }
  return endpoint;
}

std::string without_secrets(std::string_view text) {
  constexpr std::string_view property = "user-pw=", hidden = "***";
  std::string shown(text);
  // A password may contain an @ itself, so the hidden part ends at the last one.
  const std::size_t scheme = shown.find("://"), at = shown.rfind('@');
  if (scheme != std::string::npos && at != std::string::npos && at > scheme) {
    shown.replace(scheme + 3, at - scheme - 3, hidden);
  }
  for (std::size_t i = 0; (i = shown.find(property, i)) != std::string::npos;) {
    i += property.size();
    const bool quoted = i < shown.size() && shown[i] == '"';
    // The value ends after its own quotes, or before the next word.
    const std::size_t last = quoted ? shown.find('"', i + 1) : shown.find_first_of(" \t!", i);
    const std::size_t end = last == std::string::npos ? shown.size() : last + (quoted ? 1 : 0);
    shown.replace(i, end - i, hidden);
  }
  return shown;
}

}  // namespace maploop::sensors
