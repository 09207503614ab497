#include "runtime/vehicle/output/socket_buffers.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

namespace maploop::vehicle {
namespace {

class UdpSocket {
 public:
  UdpSocket() : descriptor_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~UdpSocket() { close(descriptor_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

TEST(SocketBuffers, FindsUdpSocketsAndNothingElse) {
  const std::vector<int> before = udp_sockets();
  const UdpSocket udp;
  const int stream = socket(AF_INET, SOCK_STREAM, 0);
  std::vector<int> expected = before;
  expected.push_back(udp.descriptor());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(udp_sockets(), expected);
  close(stream);
}

TEST(SocketBuffers, WhatIsGrantedIsReadBackFromTheKernel) {
  const UdpSocket udp;
  const RealtimeSetting setting = ask_for_send_buffer(udp.descriptor(), 64 * 1024);
  EXPECT_EQ(setting.verdict, Verdict::granted);
  EXPECT_EQ(setting.granted, "64 kB");
  int doubled = 0;
  socklen_t size = sizeof doubled;
  getsockopt(udp.descriptor(), SOL_SOCKET, SO_SNDBUF, &doubled, &size);
  EXPECT_EQ(doubled, 2 * 64 * 1024);
}

TEST(SocketBuffers, MoreThanTheKernelGivesIsRefusedWithTheRemedy) {
  const UdpSocket udp;
  const RealtimeSetting setting =
      ask_for_send_buffer(udp.descriptor(), std::numeric_limits<int>::max());
  EXPECT_EQ(setting.verdict, Verdict::refused);
  EXPECT_EQ(setting.remedy, "as root: sysctl -w net.core.wmem_max=2147483647");
}

TEST(SocketBuffers, ReportsWhatListenersMayRequest) {
  EXPECT_EQ(assess_receive_buffers("4194304", 2'000'000).verdict, Verdict::granted);
  const RealtimeSetting small = assess_receive_buffers("212992", 2'000'000);
  EXPECT_EQ(small.verdict, Verdict::limiting);
  EXPECT_EQ(small.granted, "up to 208 kB");
  EXPECT_EQ(small.remedy, "as root: sysctl -w net.core.rmem_max=2000000");
  EXPECT_EQ(assess_receive_buffers({}, 2'000'000).verdict, Verdict::unknown);
  EXPECT_EQ(assess_receive_buffers("x", 2'000'000).verdict, Verdict::unknown);
}

}  // namespace
}  // namespace maploop::vehicle
