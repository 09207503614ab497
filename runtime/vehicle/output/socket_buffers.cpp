#include "runtime/vehicle/output/socket_buffers.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "runtime/core/realtime_setting.h"
#include "runtime/core/realtime_text.h"

namespace maploop::vehicle {
namespace {

// Returns nullopt if the descriptor is not a socket.
std::optional<int> option(int socket, int name) {
  int value = 0;
  socklen_t size = sizeof value;
  if (getsockopt(socket, SOL_SOCKET, name, &value, &size) != 0) return {};
  return value;
}

std::string kilobytes(std::int64_t bytes) {
  return std::to_string(bytes / 1024) + " kB";
}

std::string set_limit(const char* name, int bytes) {
  return "as root: sysctl -w net.core." + std::string(name) + '=' + std::to_string(bytes);
}

}  // namespace

std::vector<int> udp_sockets() {
  std::vector<int> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const auto descriptor = runtime::parse_integer(entry.path().filename().string());
    if (!descriptor) continue;
    const int socket = static_cast<int>(*descriptor);
    if (option(socket, SO_TYPE) == SOCK_DGRAM && option(socket, SO_PROTOCOL) == IPPROTO_UDP) {
      found.push_back(socket);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

RealtimeSetting ask_for_send_buffer(int socket, int bytes) {
  const runtime::RealtimeRequest request{"LCM: send buffer", kilobytes(bytes)};
  if (setsockopt(socket, SOL_SOCKET, SO_SNDBUFFORCE, &bytes, sizeof bytes) != 0) {
    setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  }
  const int doubled = option(socket, SO_SNDBUF).value_or(0);  // socket(7): with its bookkeeping
  const int granted = doubled / 2;
  if (granted >= bytes) return request.granted(kilobytes(granted));
  return request.refused(kilobytes(granted), "net.core.wmem_max does not allow more",
                         set_limit("wmem_max", bytes));
}

RealtimeSetting assess_receive_buffers(const std::optional<std::string>& rmem_max, int bytes) {
  const runtime::RealtimeRequest request{"LCM: receive buffers", "up to " + kilobytes(bytes)};
  const auto allowed = runtime::parse_integer(rmem_max.value_or(""));
  const std::string remedy = set_limit("rmem_max", bytes);
  if (!allowed) return request.unknown("/proc/sys/net/core/rmem_max cannot be read", remedy);
  if (*allowed >= bytes) return request.granted("up to " + kilobytes(*allowed));
  return request.limiting(
      "up to " + kilobytes(*allowed),
      "a listener's recv_buf_size is limited to that, and bursts of large messages are lost",
      remedy);
}

}  // namespace maploop::vehicle
