#include "sensors/live/datagram_sender.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace maploop::sensors {

DatagramSender::DatagramSender(const Endpoint& to) {
  if (to.kind != Endpoint::Kind::udp || to.port == 0) {
    throw std::invalid_argument("cannot send datagrams to '" + to.text +
                                "': it must be udp://[ADDRESS]:PORT");
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(to.port);
  inet_pton(AF_INET, to.address.c_str(), &address.sin_addr);
  fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd_ < 0 || connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string why = std::strerror(errno);
    if (fd_ >= 0) close(fd_);
    throw std::runtime_error("cannot send to '" + to.text + "': " + why);
  }
}

DatagramSender::~DatagramSender() {
  close(fd_);
}

bool DatagramSender::send(std::span<const std::uint8_t> bytes) const {
  const auto sent = ::send(fd_, bytes.data(), bytes.size(), 0);
  return sent == static_cast<ssize_t>(bytes.size()) || errno == ECONNREFUSED;
}

}  // namespace maploop::sensors
