// This file provides connections to sensors on this host: datagrams on the loopback,
// pseudo-terminals.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sensors/clock/host_clock.h"
#include "sensors/live/live_source.h"

namespace maploop::testing {

using Bytes = std::span<const std::uint8_t>;

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

inline std::uint16_t port_of(int fd) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

// Returns a port on which no program listens. It is below the ports that the system gives away by
// itself, and each process begins at another one, so that tests that run at the same time do not
// take it from each other.
inline std::uint16_t free_port() {
  static std::uint32_t next = static_cast<std::uint32_t>(getpid()) * 16;
  const auto is_free = [](std::uint16_t port, int type) {
    const int fd = socket(AF_INET, type, 0);
    const sockaddr_in address = loopback(port);
    const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(fd);
    return bound;
  };
  for (int i = 0; i < 10'000; ++i) {
    const auto port = static_cast<std::uint16_t>(20'000 + next++ % 12'000);
    if (is_free(port, SOCK_DGRAM) && is_free(port, SOCK_STREAM)) return port;
  }
  ADD_FAILURE() << "there is no free port between 20000 and 32000";
  return 0;
}

class UdpSender {
 public:
  explicit UdpSender(std::uint16_t port) : to_(loopback(port)) {}
  ~UdpSender() { close(fd_); }
  void send(Bytes bytes) const {
    sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to_;
};

// This is a serial line whose device has a stable name, as udev gives it.
class PseudoTerminal {
 public:
  explicit PseudoTerminal(std::filesystem::path name) : name_(std::move(name)) {
    grantpt(fd_);
    unlockpt(fd_);
    std::filesystem::create_symlink(ptsname(fd_), name_);
  }
  ~PseudoTerminal() {
    std::filesystem::remove(name_);
    close(fd_);
  }
  void send(const std::string& text) const { ASSERT_GT(::write(fd_, text.data(), text.size()), 0); }

 private:
  std::filesystem::path name_;
  int fd_ = posix_openpt(O_RDWR | O_NOCTTY);
};

// This is a server to which one peer at a time connects.
class TcpServer {
 public:
  TcpServer() {
    const sockaddr_in any = loopback(0);
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
    EXPECT_EQ(listen(fd_, 1), 0);
  }
  ~TcpServer() { shut(); }
  std::string endpoint() const { return "tcp://127.0.0.1:" + std::to_string(port()); }
  std::uint16_t port() const { return port_of(fd_); }
  int peer() const { return peer_; }
  // Waits for the next peer, at most 10 s.
  bool answer() {
    hang_up();
    pollfd waiting{fd_, POLLIN, 0};
    if (poll(&waiting, 1, 10'000) > 0) peer_ = accept(fd_, nullptr, nullptr);
    return peer_ >= 0;
  }
  void hang_up() {
    if (peer_ >= 0) close(peer_);
    peer_ = -1;
  }
  // No peer is answered any more.
  void shut() {
    hang_up();
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(peer_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  // Returns what the peer sends up to `end`, or within 10 s.
  std::string receive_until(std::string_view end) const {
    std::string heard;
    char c = 0;
    for (pollfd p{peer_, POLLIN, 0}; poll(&p, 1, 10'000) > 0 && recv(peer_, &c, 1, 0) == 1;) {
      heard += c;
      if (heard.ends_with(end)) break;
    }
    return heard;
  }

 private:
  int fd_ = socket(AF_INET, SOCK_STREAM, 0);
  int peer_ = -1;
};

// Waits for the next sample of a live sensor, at most that long.
template <class T>
bool wait_for(sensors::LiveSource<T>& source, T& sample, Duration most = std::chrono::seconds(20)) {
  const sensors::HostClock clock;
  const Time end = clock.now() + most;
  while (clock.now() < end) {
    if (source.wait(sample, std::chrono::milliseconds(20))) return true;
  }
  return false;
}

// Waits, at most 10 s, until the sensor is connected or is not any more.
template <class T>
bool wait_until_open(sensors::LiveSource<T>& source, bool open) {
  T sample;
  for (int i = 0; i < 500 && source.report().connection.open != open; ++i) {
    source.wait(sample, std::chrono::milliseconds(20));
  }
  EXPECT_EQ(source.report().connection.open, open) << source.report().connection.problem;
  return source.report().connection.open == open;
}

// Returns what a sensor says of itself, a line each.
inline std::string all_of(const sensors::LiveReport& report) {
  std::string said;
  for (const auto* texts : {&report.notes, &report.reasons}) {
    for (const std::string& text : *texts) said += text + '\n';
  }
  return said;
}

inline std::string sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char text[160];
  std::snprintf(text, sizeof text, "$%s*%02X\r\n", body.c_str(), sum);
  return text;
}

inline std::string epoch(int second) {
  char time[16];
  std::snprintf(time, sizeof time, "1018%02d.00", second);
  return sentence(std::string("GNGGA,") + time +
                  ",4858.9500,N,00823.4200,E,1,12,0.80,115.2,M,47.9,M,,") +
         sentence(std::string("GNRMC,") + time +
                  ",A,4858.9500,N,00823.4200,E,19.438,90.0,010326,,,A");
}

}  // namespace maploop::testing
