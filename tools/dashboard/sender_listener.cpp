#include "tools/dashboard/sender_listener.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace maploop::dashboard {
namespace {

constexpr std::string_view scheme = "udpm://";
constexpr std::uint32_t whole = 0x4c433032, part = 0x4c433033;  // "LC02", "LC03"
constexpr std::size_t whole_header = 8, part_header = 20;
constexpr std::size_t longest_packet = 65536, longest_message = 16u << 20;
constexpr std::size_t most_partial = 32;  // so that a flood takes no more memory

struct Group {
  std::string address = "239.255.76.67";
  int port = 7667;
};

std::optional<Group> group_of(std::string_view url) {
  if (!url.starts_with(scheme)) return std::nullopt;
  const std::string_view place = url.substr(scheme.size(), url.find('?') - scheme.size());
  const std::size_t colon = place.find(':');
  Group group;
  if (colon != 0 && !place.empty()) group.address = place.substr(0, colon);
  if (colon != std::string_view::npos)
    group.port = std::atoi(std::string(place.substr(colon + 1)).c_str());
  in_addr address{};
  const bool right = inet_pton(AF_INET, group.address.c_str(), &address) == 1 &&
                     IN_MULTICAST(ntohl(address.s_addr)) && group.port > 0 && group.port < 65536;
  return right ? std::optional(group) : std::nullopt;
}

template <class Number>
Number number_at(std::span<const std::uint8_t> packet, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) value = value << 8 | packet[at + i];
  return static_cast<Number>(value);
}

// Returns the name at the beginning of a packet's contents, and removes it; nothing if it has no
// end.
std::optional<std::string_view> take_channel(std::span<const std::uint8_t>& contents) {
  const auto end = std::find(contents.begin(), contents.end(), 0);
  if (end == contents.end()) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - contents.begin());
  const std::string_view name(reinterpret_cast<const char*>(contents.data()), length);
  contents = contents.subspan(length + 1);
  return name;
}

int open_socket(const Group& group) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1, buffer = 4 << 20;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);  // as much as is allowed
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(group.port));
  inet_pton(AF_INET, group.address.c_str(), &at.sin_addr);
  ip_mreq member{at.sin_addr, {}};
  if (bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0 &&
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) == 0) {
    return fd;
  }
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

}  // namespace

bool SenderListener::understands(std::string_view url) {
  return group_of(url).has_value();
}

SenderListener::SenderListener(std::string_view url, Handler handler)
    : socket_(open_socket(group_of(url).value())), handler_(std::move(handler)) {
  if (socket_ < 0) {
    throw std::runtime_error("cannot listen at '" + std::string(url) + "': " + strerror(errno));
  }
}

SenderListener::~SenderListener() {
  close(socket_);
}

void SenderListener::listen(int milliseconds) {
  pollfd waiting{socket_, POLLIN, 0};
  if (poll(&waiting, 1, milliseconds) <= 0) return;
  std::array<std::uint8_t, longest_packet> packet;
  constexpr int at_most = 1000;  // so that the caller comes to its other work
  for (int i = 0; i < at_most; ++i) {
    sockaddr_in from{};
    socklen_t length = sizeof from;
    const ssize_t size = recvfrom(socket_, packet.data(), packet.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &length);
    if (size < 0) return;
    std::array<char, INET_ADDRSTRLEN> address{};
    inet_ntop(AF_INET, &from.sin_addr, address.data(), address.size());
    take(std::string(address.data()) + ':' + std::to_string(ntohs(from.sin_port)),
         std::span(packet).first(static_cast<std::size_t>(size)));
  }
}

void SenderListener::take(const std::string& sender, std::span<const std::uint8_t> packet) {
  if (packet.size() < whole_header) return;
  const auto kind = number_at<std::uint32_t>(packet, 0);
  if (kind == part) return take_part(sender, packet);
  if (kind != whole) return;
  std::span<const std::uint8_t> contents = packet.subspan(whole_header);
  if (const auto channel = take_channel(contents)) pass_on(sender, *channel, contents);
}

void SenderListener::take_part(const std::string& sender, std::span<const std::uint8_t> packet) {
  if (packet.size() < part_header) return;
  const auto number = number_at<std::uint32_t>(packet, 4),
             size = number_at<std::uint32_t>(packet, 8);
  const auto offset = number_at<std::uint32_t>(packet, 12);
  const auto index = number_at<std::uint16_t>(packet, 16),
             count = number_at<std::uint16_t>(packet, 18);
  std::span<const std::uint8_t> contents = packet.subspan(part_header);
  if (index == 0) {
    const auto channel = take_channel(contents);
    if (!channel || size > longest_message) return;
    if (partial_.size() >= most_partial) partial_.clear();
    partial_[sender] = {number, count, std::string(*channel), std::vector<std::uint8_t>(size)};
  }
  const auto found = partial_.find(sender);
  if (found == partial_.end() || found->second.number != number) return;  // a part was lost
  Partial& message = found->second;
  if (contents.size() > message.data.size() || offset > message.data.size() - contents.size()) {
    return;
  }
  std::copy(contents.begin(), contents.end(), message.data.begin() + offset);
  if (message.missing == 0 || --message.missing > 0) return;
  pass_on(sender, message.channel, message.data);
  partial_.erase(found);
}

void SenderListener::pass_on(std::string_view sender, std::string_view channel,
                             std::span<const std::uint8_t> data) {
  // Each new listener's library tries itself by this channel.
  if (channel != "LCM_SELF_TEST") handler_(sender, channel, data);
}

}  // namespace maploop::dashboard
