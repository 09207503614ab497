// Tests that messages are received with their senders, as LCM's own library sends them.
#include "tools/dashboard/sender_listener.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::dashboard {
namespace {

constexpr const char* url = "udpm://239.255.76.67:7673?ttl=0";

TEST(SenderListener, KnowsBusesOfUdpAlone) {
  EXPECT_TRUE(SenderListener::understands(url));
  EXPECT_TRUE(SenderListener::understands("udpm://"));
  for (const char* other : {"", "tcpq://127.0.0.1:7700", "udpm://10.0.0.1:7667", "udpm://a:b"})
    EXPECT_FALSE(SenderListener::understands(other)) << other;
}

TEST(SenderListener, SmallAndLargeMessagesHaveTheAddressOfTheirProgram) {
  vehicle::LcmBus first(url), second(url);
  const auto publish = [](vehicle::LcmBus& bus, const char* channel, const auto& data) {
    bus.lcm().publish(channel, data.data(), static_cast<unsigned>(data.size()));
  };
  std::map<std::string, std::set<std::string>> senders;  // by channel
  std::vector<std::uint8_t> large(300'000), heard;
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i * 7);
  SenderListener listener(url, [&](auto sender, auto channel, auto data) {
    senders[std::string(channel)].emplace(sender);
    if (channel == "LARGE") heard.assign(data.begin(), data.end());
  });
  const std::vector<std::uint8_t> small{1, 2, 3};
  for (int i = 0; i < 20 && senders.size() < 3; ++i) {  // the kernel may drop a large one
    publish(first, "FIRST", small);
    publish(second, "SECOND", small);
    publish(first, "LARGE", large);
    listener.listen(100);
  }
  ASSERT_EQ(senders.size(), 3u) << "of a bus on this host: is there a multicast route?";
  EXPECT_EQ(heard, large);
  EXPECT_EQ(senders["FIRST"].size(), 1u);
  EXPECT_EQ(senders["FIRST"], senders["LARGE"]);
  EXPECT_NE(senders["FIRST"], senders["SECOND"]);
}

}  // namespace
}  // namespace maploop::dashboard
