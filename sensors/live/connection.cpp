#include "sensors/live/connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "sensors/live/serial_port.h"

namespace maploop::sensors {
namespace {

constexpr Duration between_attempts = std::chrono::milliseconds(500);
constexpr Duration longest_connecting = std::chrono::seconds(5);

MonotonicTime now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

timespec as_timespec(Duration d) {
  const auto ns = std::max<std::int64_t>(0, d.count());
  return {ns / 1'000'000'000, ns % 1'000'000'000};
}

// Waits until `deadline` and returns the events that occurred; 0 if none did.
short poll_until(int fd, short events, MonotonicTime deadline) {
  pollfd p{fd, events, 0};
  const timespec left = as_timespec(deadline - now());
  return ppoll(&p, 1, &left, nullptr) > 0 ? p.revents : short{0};
}

void sleep_until(MonotonicTime deadline) {
  const timespec left = as_timespec(deadline - now());
  nanosleep(&left, nullptr);
}

// A peer whose cable is pulled, or that restarts, sends nothing. After 2 s of silence a keepalive
// is sent each second, and the connection is closed after 3 without an answer.
void notice_dead_peers(int fd) {
  const auto set = [fd](int level, int option, int value) {
    setsockopt(fd, level, option, &value, sizeof value);
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 2);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, 5000);  // ms in which data must be acknowledged
}

}  // namespace

void Connection::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  connecting_ = state_.open = false;
}

void Connection::fail(std::string problem) {
  close();
  state_.problem = std::move(problem);
  next_attempt_ = now() + between_attempts;
}

bool Connection::write(std::string_view text) {
  if (!state_.open || endpoint_.kind != Endpoint::Kind::tcp) return false;
  return send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
}

std::uint16_t Connection::port() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (fd_ < 0 || getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return ntohs(address.sin_port);
}

int Connection::open_socket(std::string& problem) {
  const bool udp = endpoint_.kind == Endpoint::Kind::udp;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint_.port);
  inet_pton(AF_INET, endpoint_.address.c_str(), &address.sin_addr);
  const auto* where = reinterpret_cast<const sockaddr*>(&address);
  const int fd =
      socket(AF_INET, (udp ? SOCK_DGRAM : SOCK_STREAM) | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  bool good = fd >= 0;
  if (good && udp) {
    const int bytes = 4 << 20;  // holds over a scan; any granted size holds a packet
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    good = bind(fd, where, sizeof address) == 0;
  } else if (good) {
    notice_dead_peers(fd);
    connecting_ = connect(fd, where, sizeof address) != 0;
    good = !connecting_ || errno == EINPROGRESS;
  }
  if (good) return fd;
  problem = std::string(udp ? "cannot be listened on: " : "cannot be connected to: ") +
            std::strerror(errno) +
            (errno == EADDRNOTAVAIL ? "; no interface has this address" : "");
  if (fd >= 0) ::close(fd);
  return -1;
}

void Connection::open() {
  std::string problem;
  connecting_ = false;
  const int fd = endpoint_.kind == Endpoint::Kind::serial
                     ? open_serial(endpoint_.device, endpoint_.baud, problem)
                     : open_socket(problem);
  if (fd < 0) {
    fail(std::move(problem));
    return;
  }
  fd_ = fd;
  give_up_ = now() + longest_connecting;
}

bool Connection::finish_connecting(MonotonicTime deadline) {
  if (!connecting_) return true;
  if (poll_until(fd_, POLLOUT, deadline) == 0) {
    if (now() > give_up_) fail("cannot be connected to: there is no answer");
    return false;
  }
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
  if (error != 0) {
    fail(std::string("cannot be connected to: ") + std::strerror(error));
    return false;
  }
  connecting_ = false;
  return true;
}

bool Connection::wait_open(MonotonicTime deadline) {
  if (state_.open) return true;
  if (fd_ < 0 && now() < next_attempt_) {
    sleep_until(std::min(deadline, next_attempt_));
    if (now() < next_attempt_) return false;
  }
  if (fd_ < 0) open();
  if (fd_ < 0 || !finish_connecting(deadline)) return false;
  state_.open = true;
  ++state_.opened;
  state_.problem.clear();
  return true;
}

std::size_t Connection::receive(std::span<std::uint8_t> to) {
  if (endpoint_.kind == Endpoint::Kind::udp) {
    const ssize_t size = recv(fd_, to.data(), to.size(), MSG_TRUNC);
    if (size <= 0) return 0;  // an empty datagram, or an error due to an earlier one
    if (static_cast<std::size_t>(size) <= to.size()) return static_cast<std::size_t>(size);
    ++state_.too_large;
    return 0;
  }
  const ssize_t size = ::read(fd_, to.data(), to.size());
  if (size > 0) return static_cast<std::size_t>(size);
  if (size == 0 || (errno != EAGAIN && errno != EINTR)) {
    fail(size == 0 ? "was closed by the other side"
                   : std::string("has failed: ") + std::strerror(errno) + "; was it unplugged?");
  }
  return 0;
}

std::size_t Connection::read(std::span<std::uint8_t> to, Duration patience) {
  const MonotonicTime deadline = now() + patience;
  if (!wait_open(deadline)) return 0;
  while (state_.open && poll_until(fd_, POLLIN, deadline) != 0) {
    const std::size_t size = receive(to);
    state_.bytes += size;
    // A datagram that is dropped does not end the waiting.
    if (size > 0 || now() >= deadline) return size;
  }
  return 0;
}

}  // namespace maploop::sensors
