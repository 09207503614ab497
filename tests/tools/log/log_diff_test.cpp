// Tests the comparison of logs.
#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tests/tools/log/small_log.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

class LogDiffTest : public LogToolsTest {
 protected:
  bool same_as(const std::vector<TestEvent>& events, const char* channels = ".*") {
    record(out_, events);
    said_.str("");
    return diff(log_, out_, types_, matching(channels), said_);
  }

  bool says(const std::string& text) const { return contains(said_.str(), text); }

  // Returns a line about one side of a difference.
  std::string side(const path& log, const std::string& text) const {
    return "    " + log.string() + ": " + text + '\n';
  }

  std::ostringstream said_;
};

TEST_F(LogDiffTest, SameMessagesAtOtherTimesInAnotherOrderOfChannelsAreTheSame) {
  auto events = drive_;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.channel < b.channel; });
  for (TestEvent& e : events) e.time_us += 5;
  events.push_back({"LCM_SELF_TEST", test_start, {1, 2, 3}});  // LCM sends it to itself
  EXPECT_TRUE(same_as(events));
  EXPECT_EQ(said_.str(),
            "CAMERA_TRIGGER: same, 4 messages\nHEALTH: same, 4 messages\nIMU: same, 4 messages\n"
            "NAV_STATE: same, 8 messages\nX: same, 4 messages\n");
}

TEST_F(LogDiffTest, NamesFirstDifferingMessageAndField) {
  auto events = drive_;
  events[9].data = events[12].data = nav_state_bytes(1.25);
  EXPECT_FALSE(same_as(events));
  // The messages of the channel are events 0, 3, 6, 9, ...
  EXPECT_TRUE(
      says("NAV_STATE: different: 8 and 8 messages, 2 of them differ\n"
           "  message 3, position_enu[0]\n" +
           side(log_, "2011-09-26 13:10:51.090000  0.9") +
           side(out_, "2011-09-26 13:10:51.090000  1.25")))
      << said_.str();
  EXPECT_TRUE(says("IMU: same"));
  EXPECT_TRUE(same_as(events, "IMU|X")) << "only the chosen channels count";
}

TEST_F(LogDiffTest, MissingMessagesAndChannels) {
  auto events = drive_;
  events.pop_back();  // the last message of X
  std::erase_if(events, [](const auto& e) { return e.channel == "IMU"; });
  events.push_back({"NEW", test_start, {1}});
  EXPECT_FALSE(same_as(events));
  EXPECT_TRUE(says("X: different: 4 and 3 messages, 0 of them differ\n  message 3\n" +
                   side(log_, "2011-09-26 13:10:51.230000") + side(out_, "has no such message")))
      << said_.str();
  EXPECT_TRUE(says("IMU: different: 4 and 0 messages, 0 of them differ\n  message 0\n"));
  EXPECT_TRUE(says("NEW: different: 0 and 1 messages, 0 of them differ\n  message 0\n"));
}

TEST_F(LogDiffTest, WhatCannotBeComparedIsAnError) {
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { same_as(drive_, "NO"); }),
                       "nothing was compared"));
  damage(offsets_[3], 0xff);
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { same_as(drive_); }),
                       "is damaged at byte " + std::to_string(offsets_[3])));
}

std::string difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  const auto d = compare(a, b, schema::own_schema());
  return d ? d->field + ": " + d->a + " | " + d->b : "same";
}

TEST(FieldDifference, OddCases) {
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
  EXPECT_EQ(difference(a, b),
            "position_enu[0]: nan (0x7ff8000000000000) | nan (0x7ff8000000000001)");
}

}  // namespace
}  // namespace maploop::lcm_log
