// This test checks that sent camera images carry the moments at which they were due.
#include "sensors/live/video_sender.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sensors/clock/host_clock.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;

// Receives datagrams at a free port of the loopback.
class Receiver {
 public:
  Receiver() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    bound_ = ::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
             ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    port_ = ntohs(address.sin_port);
  }
  ~Receiver() { ::close(socket_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  bool bound() const { return bound_; }
  int port() const { return port_; }

  // Returns the RTP time of the next packet that ends an image, 90 000 a second; nothing within 10
  // s.
  std::optional<std::uint32_t> next_image() {
    std::array<std::uint8_t, 65536> packet{};
    pollfd ready{socket_, POLLIN, 0};
    while (::poll(&ready, 1, 10'000) > 0) {
      const auto size = ::recv(socket_, packet.data(), packet.size(), 0);
      // Shorter packets contain events and the format.
      constexpr int header = 12, pixels = 2 * 32 * 16;
      const bool ends_image = size > header + pixels && (packet[1] & 0x80) != 0;
      if (!ends_image) continue;
      return std::uint32_t{packet[4]} << 24 | std::uint32_t{packet[5]} << 16 |
             std::uint32_t{packet[6]} << 8 | std::uint32_t{packet[7]};
    }
    return std::nullopt;
  }

 private:
  int socket_;
  int port_ = 0;
  bool bound_ = false;
};

StereoPair dark_pair() {
  StereoPair pair;
  pair.left.resize(32, 16);
  pair.right.resize(32, 16);
  return pair;
}

TEST(VideoSender, AnImageThatIsSentLateKeepsTheMomentItWasDue) {
  Receiver receiver;
  ASSERT_TRUE(receiver.bound());
  VideoSender sender(
      "rtpgstpay mtu=60000 ! udpsink host=127.0.0.1 port=" + std::to_string(receiver.port()), 32,
      16, 10.0);
  const HostClock clock;
  const Time first = clock.now();
  const StereoPair pair = dark_pair();
  std::optional<std::uint32_t> begin;
  int sent = 0;
  Duration longest{};  // of the calls of send(), which takes the time for itself
  for (const Duration late : {milliseconds(0), milliseconds(80), milliseconds(30)}) {
    const Time due = first + sent * milliseconds(200);
    while (clock.now() < due + late) ::usleep(1000);
    const Time before = clock.now();
    ASSERT_TRUE(sender.send(pair, before - due));
    longest = std::max(longest, clock.now() - before);
    const auto time = receiver.next_image();
    ASSERT_TRUE(time) << sent;
    if (!begin) begin = *time;
    constexpr double ticks = 90.0;  // a millisecond
    EXPECT_NEAR((*time - *begin) / ticks, 200.0 * sent, 5.0 + to_milliseconds(longest)) << sent;
    ++sent;
  }
}

TEST(VideoSender, RefusesAnImageOfAnotherSize) {
  VideoSender sender("fakesink", 64, 16, 10.0);
  EXPECT_FALSE(sender.send(dark_pair(), Duration::zero()));
}

}  // namespace
}  // namespace maploop::sensors
