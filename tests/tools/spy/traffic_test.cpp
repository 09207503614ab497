#include "tools/spy/traffic.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/tools/spy/messages.h"

namespace maploop::spy {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time drive = from_nanoseconds(1'317'042'651'000'000'000);

ChannelStatus only(const Traffic& traffic, Duration now) {
  const auto channels = traffic.status(now, lcm_log::matching(".*"));
  EXPECT_EQ(channels.size(), 1u);
  return channels.at(0);
}

TEST(SpyTraffic, RateAndJitterAreOfTheWindow) {
  Traffic traffic(own_schema(), seconds(5));
  int ms = 0;
  for (int i = 0; i < 100; ++i) traffic.add("IMU", imu(i, drive), milliseconds(ms += 1));
  for (int i = 100; i < 160; ++i) {  // slower, and every other one 20 ms late
    traffic.add("IMU", imu(i, drive), milliseconds(ms += i % 2 == 0 ? 80 : 120));
  }
  const ChannelStatus s = only(traffic, milliseconds(ms));
  EXPECT_EQ(s.count, 160u);
  EXPECT_NEAR(*s.rate_hz, 10.0, 0.1) << "what was before the window does not count";
  EXPECT_NEAR(*s.jitter_s, 0.020, 0.001);
  EXPECT_EQ(s.silent_s, 0.0);
}

TEST(SpyTraffic, OneMessageHasNoRateAndSilenceIsZero) {
  Traffic traffic(own_schema(), seconds(5));
  traffic.add("IMU", imu(0, drive), seconds(1));
  EXPECT_FALSE(only(traffic, seconds(2)).rate_hz);
  EXPECT_FALSE(only(traffic, seconds(2)).jitter_s);
  EXPECT_EQ(only(traffic, seconds(2)).silent_s, 1.0);
  EXPECT_EQ(*only(traffic, seconds(8)).rate_hz, 0.0) << "silent for longer than the window";
}

TEST(SpyTraffic, GapsOfTheSequenceAreLosses) {
  Traffic traffic(own_schema(), seconds(5));
  for (const int sequence : {4, 5, 8, 9, 19}) {
    traffic.add("IMU", imu(static_cast<std::uint64_t>(sequence), drive), seconds(1));
  }
  EXPECT_EQ(*only(traffic, seconds(1)).lost, 2u + 9u);
  traffic.add("IMU", imu(0, drive), seconds(2));
  traffic.add("IMU", imu(1, drive), seconds(2));
  EXPECT_EQ(*only(traffic, seconds(2)).lost, 11u) << "started again: no loss";
}

TEST(SpyTraffic, AgesAreBehindTheNewestStampOfAnyChannel) {
  Traffic traffic(own_schema(), seconds(5));
  const auto all = lcm_log::matching(".*");
  traffic.add("A", imu(7, drive), seconds(1));
  traffic.add("B", imu(7, drive + milliseconds(1500)), seconds(1));
  auto channels = traffic.status(seconds(1), all);
  EXPECT_NEAR(*channels[0].age_s, 1.5, 1e-9) << "years after the drive";
  EXPECT_EQ(*channels[1].age_s, 0.0);
  // The replay restarts: the former stamps no longer count as `now`.
  traffic.add("A", imu(0, drive - seconds(60)), seconds(2));
  traffic.add("B", imu(0, drive - seconds(61)), seconds(2));
  channels = traffic.status(seconds(2), all);
  EXPECT_LT(*channels[0].age_s, 2.0);
  EXPECT_LT(*channels[1].age_s, 2.0);
}

TEST(SpyTraffic, HealthHasAStampButNoSequence) {
  Traffic traffic(own_schema(), seconds(5));
  Health health;
  health.stamp = drive;
  traffic.add("HEALTH", encoded(to_lcm(health)), seconds(1));
  const ChannelStatus s = only(traffic, seconds(1));
  EXPECT_EQ(s.type, "maploop_lcm.health_t");
  EXPECT_EQ(*s.age_s, 0.0);
  EXPECT_FALSE(s.lost);
  EXPECT_EQ(s.bad, 0u);
}

TEST(SpyTraffic, AReplayThatStartsAgainIsSeenByAStampThatGoesBack) {
  Traffic traffic(own_schema(), seconds(5));
  Health health;
  health.stamp = drive + seconds(14);
  traffic.add("HEALTH", encoded(to_lcm(health)),
              seconds(1));  // all that was heard of its last round
  health.stamp = drive + seconds(1);
  traffic.add("HEALTH", encoded(to_lcm(health)), seconds(2));
  traffic.add("IMU", imu(0, drive + seconds(1)), seconds(2));
  for (const ChannelStatus& s : traffic.status(seconds(2), lcm_log::matching(".*"))) {
    EXPECT_EQ(*s.age_s, 0.0) << s.name;
  }
}

TEST(SpyTraffic, WhatCannotBeDecodedIsCountedAndHarmsNobody) {
  Traffic traffic(own_schema(), seconds(5));
  auto cut = imu(1, drive);
  cut.resize(20);
  traffic.add("IMU", imu(0, drive), seconds(1));
  traffic.add("IMU", cut, seconds(1));
  traffic.add("IMU", {}, seconds(1));
  traffic.add("IMU", std::vector<std::uint8_t>(100, 0xff), seconds(1));
  ChannelStatus s = only(traffic, seconds(1));
  EXPECT_EQ(s.bad, 3u);
  EXPECT_EQ(s.type, "0xffffffffffffffff");
  EXPECT_FALSE(s.age_s);
  traffic.add("IMU", imu(1, drive), seconds(1));
  s = only(traffic, seconds(1));
  EXPECT_EQ(s.bad, 3u);
  EXPECT_EQ(*s.lost, 0u);
}

TEST(SpyTraffic, AnyNumberOfChannelsTakesBoundedMemory) {
  Traffic traffic(own_schema(), seconds(5));
  for (int i = 0; i < 1500; ++i) traffic.add("C" + std::to_string(i), {}, seconds(1));
  EXPECT_EQ(traffic.status(seconds(1), lcm_log::matching(".*")).size(), 1000u);
  EXPECT_EQ(traffic.elsewhere(), 500u);
  EXPECT_EQ(traffic.count(), 1500u);
}

}  // namespace
}  // namespace maploop::spy
