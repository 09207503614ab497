// Tests the comparison of logs.
#include "tools/log/log_diff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tests/tools/log/log_tools_fixture.h"

namespace maploop::lcm_log {
namespace {

class LogDiffTest : public LogToolsTest {
 protected:
  LogDiff compare_with(const std::vector<TestEvent>& events, ChannelFilter filter = {}) {
    record(other_, events);
    return diff(log_, other_, types(), std::move(filter));
  }

  static const ChannelDiff& channel(const LogDiff& diff, const std::string& name) {
    return *std::find_if(diff.channels.begin(), diff.channels.end(),
                         [&](const ChannelDiff& c) { return c.channel == name; });
  }

  const path other_ = folder_.path() / "b.lcmlog";
};

TEST_F(LogDiffTest, SameMessagesAtOtherTimesInAnotherOrderOfChannelsAreTheSame) {
  auto events = drive_;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.channel < b.channel; });
  for (TestEvent& e : events) e.time_us += 5;
  const LogDiff result = compare_with(events);
  EXPECT_TRUE(result.same());
  EXPECT_EQ(result.channels.size(), 5U);
}

TEST_F(LogDiffTest, NamesFirstDifferingMessageAndField) {
  auto events = drive_;
  events[9].data = nav_state_bytes(1.25);
  events[12].data = nav_state_bytes(1.25);
  const LogDiff result = compare_with(events);
  EXPECT_FALSE(result.same());
  const ChannelDiff& c = channel(result, "NAV_STATE");
  EXPECT_EQ(c.number, 3U);  // events 0, 3, 6, 9
  EXPECT_EQ(c.differing, 2U);
  EXPECT_EQ(c.time_a_us, drive_[9].time_us);
  ASSERT_TRUE(c.field);
  EXPECT_EQ(c.field->field, "position_enu[0]");
  EXPECT_EQ(c.field->a, "0.9");
  EXPECT_EQ(c.field->b, "1.25");
  EXPECT_TRUE(channel(result, "IMU").same());
  EXPECT_TRUE(contains(format_diff(result, "a", "b"), "message 3, position_enu[0]"));
}

TEST_F(LogDiffTest, MissingMessagesAndChannels) {
  auto events = drive_;
  events.pop_back();  // the last message of X
  std::erase_if(events, [](const auto& e) { return e.channel == "IMU"; });
  events.push_back({"NEW", kTestStart, {1}});
  const LogDiff result = compare_with(events);
  EXPECT_EQ(channel(result, "X").number, 3U);
  EXPECT_EQ(channel(result, "X").time_a_us, drive_[23].time_us);
  EXPECT_FALSE(channel(result, "X").time_b_us);
  EXPECT_EQ(channel(result, "IMU").number, 0U);
  EXPECT_EQ(channel(result, "NEW").count_a, 0U);
  EXPECT_FALSE(channel(result, "NEW").same());
  EXPECT_TRUE(contains(format_diff(result, "a", "b"), "has no such message"));
}

TEST_F(LogDiffTest, WhatLcmSendsToItselfIsNoDifference) {
  auto events = drive_;
  events.push_back({"LCM_SELF_TEST", kTestStart, {1, 2, 3}});
  const LogDiff result = compare_with(events);
  EXPECT_TRUE(result.same());
  EXPECT_EQ(result.channels.size(), 5U);
}

TEST_F(LogDiffTest, OnlyTheChosenChannelsCount) {
  auto events = drive_;
  events[9].data = nav_state_bytes(1.25);
  EXPECT_TRUE(compare_with(events, ChannelFilter("IMU|X")).same());
}

TEST_F(LogDiffTest, DamagedLogCannotBeCompared) {
  record(other_, drive_);
  damage(offsets_[3], 0xff);
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { diff(log_, other_, types(), {}); }),
                       "is damaged at byte " + std::to_string(offsets_[3])));
}

TEST(FieldDifference, OddCases) {
  const auto difference = [](const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b) {
    const auto d = compare(a, b, types());
    return d ? d->field + ": " + d->a + " | " + d->b : "same";
  };
  EXPECT_EQ(difference({}, {}), "same");
  EXPECT_EQ(difference({}, {1}), "byte 0: nothing: 0 bytes in all | 0x01");
  EXPECT_EQ(difference(unknown_bytes(20, 1), unknown_bytes(20, 2)), "byte 8: 0x01 | 0x02");
  EXPECT_EQ(difference(unknown_bytes(20, 1), nav_state_bytes(0.0)),
            "type: unknown type 0x05529fec3986d320 | maploop_lcm.nav_state_t");
  EXPECT_EQ(difference(health_bytes(1), health_bytes(2)), "thread_count: 1 | 2");
  EXPECT_EQ(difference(nav_state_bytes(0.0), nav_state_bytes(-0.0)), "position_enu[0]: 0 | -0");
  auto cut = nav_state_bytes(0.0);
  cut.resize(100);
  EXPECT_EQ(difference(cut, nav_state_bytes(0.0)), "byte 100: nothing: 100 bytes in all | 0x00");
}

TEST(FieldDifference, NansShowTheirBits) {
  const auto a = nav_state_bytes(std::numeric_limits<double>::quiet_NaN());
  auto b = a;
  const auto at = std::mismatch(a.begin(), a.end(), nav_state_bytes(0.0).begin()).first - a.begin();
  b[static_cast<std::size_t>(at) + 7] ^= 1;
  const auto d = compare(a, b, types());
  ASSERT_TRUE(d);
  EXPECT_EQ(d->field, "position_enu[0]");
  EXPECT_EQ(d->a, "nan (0x7ff8000000000000)");
  EXPECT_EQ(d->b, "nan (0x7ff8000000000001)");
}

}  // namespace
}  // namespace maploop::lcm_log
