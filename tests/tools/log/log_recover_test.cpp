// Tests the recovery of damaged logs, read back by LCM itself, and the report of losses.
#include "tools/log/log_recover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "msgs/lcm/log/log_header.h"
#include "tests/tools/log/log_tools_fixture.h"
#include "tools/log/log_verify.h"

namespace maploop::lcm_log {
namespace {

TEST_F(LogToolsTest, RecoverSaysWhatWasLost) {
  auto bytes = read_bytes(log_);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[4]),
            bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[6]) + 10, std::uint8_t{0});
  bytes.erase(bytes.end() - 5, bytes.end());
  write_bytes(log_, bytes);
  const Recovery r = recover(log_, types(), out_);
  ASSERT_EQ(r.loss_count, 2U) << format_report(r);
  EXPECT_EQ(r.losses[0].begin, offsets_[4]);
  EXPECT_EQ(r.losses[0].end, offsets_[7]);
  EXPECT_EQ(r.losses[0].first_event, 4);
  EXPECT_EQ(r.losses[0].last_event, 6);
  EXPECT_EQ(r.losses[0].after_us, drive_[3].time_us);
  EXPECT_EQ(r.losses[0].before_us, drive_[7].time_us);
  EXPECT_TRUE(contains(r.losses[0].reason, "event 3 before it is kept")) << r.losses[0].reason;
  EXPECT_EQ(r.losses[1].begin, offsets_[23]);
  EXPECT_FALSE(r.losses[1].before_us);
  EXPECT_EQ(r.lost_events, 3U);
  EXPECT_TRUE(contains(format_report(r), "events 4 to 6")) << format_report(r);

  auto expected = drive_;
  expected.pop_back();
  expected.erase(expected.begin() + 4, expected.begin() + 7);
  EXPECT_EQ(read_with_lcm(out_), expected);
  EXPECT_EQ(verify(out_, types()).finding_count, 0U);
}

TEST_F(LogToolsTest, RecoverOfASoundLogIsTheLog) {
  const Recovery r = recover(log_, types(), out_);
  EXPECT_EQ(r.loss_count, 0U);
  EXPECT_EQ(r.repair_count, 0U);
  EXPECT_EQ(read_bytes(out_), read_bytes(log_));
}

TEST_F(LogToolsTest, RecoverRepairsTimesThatItsNeighboursContradict) {
  const auto whole = read_bytes(log_);
  for (const std::size_t event : {0U, 1U, 11U, 22U}) {
    write_bytes(log_, whole);
    damage(offsets_[event] + 13, 0x10);  // a time error of nine years
    const Recovery r = recover(log_, types(), out_);
    EXPECT_EQ(r.repair_count, 1U) << event;
    EXPECT_TRUE(contains(format_report(r), "repaired"));
    EXPECT_EQ(verify(out_, types()).finding_count, 0U) << event;
    const auto events = read_with_lcm(out_);
    ASSERT_EQ(events.size(), drive_.size());
    EXPECT_NEAR(static_cast<double>(events[event].time_us),
                static_cast<double>(drive_[event].time_us), 10'001.0);
    EXPECT_EQ(events[event].data, drive_[event].data);
  }
}

TEST_F(LogToolsTest, RecoverKeepsARealPause) {
  auto events = drive_;
  for (std::size_t i = 12; i < events.size(); ++i) events[i].time_us += 86'400'000'000;
  record(log_, events);
  EXPECT_EQ(recover(log_, types(), out_).repair_count, 0U);
  EXPECT_EQ(read_with_lcm(out_), events);
}

TEST_F(LogToolsTest, RecoverLeavesOutWhatDoesNotDecode) {
  damage(offsets_[7] + kHeaderBytes + 6 + 8 + 8, 0x40);  // a million more threads
  const Recovery r = recover(log_, types(), out_);
  ASSERT_EQ(r.loss_count, 1U);
  EXPECT_EQ(r.losses[0].first_event, 7);
  EXPECT_TRUE(contains(r.losses[0].reason, "HEALTH does not decode"));
  EXPECT_EQ(r.lost_events, 1U);
  EXPECT_EQ(read_with_lcm(out_).size(), 23U);
}

TEST_F(LogToolsTest, RecoverOfWhatHoldsNoEventWritesNothing) {
  write_bytes(log_, std::vector<std::uint8_t>(1000, 0x55));
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { recover(log_, types(), out_); }),
                       "no readable event"));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_THROW(recover(log_, types(), log_), std::invalid_argument);
}

TEST_F(LogToolsTest, RecoverCountsWithNumbersThatAreFarApart) {
  auto bytes = read_bytes(log_);
  bytes[offsets_[3]] ^= 0xffU;      // not an event any more: a loss
  bytes[offsets_[4] + 4] ^= 0x7fU;  // the number of the event after it
  bytes[offsets_[2] + 4] ^= 0x80U;  // the number of the event before it
  write_bytes(log_, bytes);
  EXPECT_EQ(recover(log_, types(), out_).events, drive_.size() - 1);
}

TEST_F(LogToolsTest, RecoveredLogsAreSoundWhateverWasDamaged) {
  const auto whole = read_bytes(log_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 300; ++round) {
    auto bytes = whole;
    for (auto n = 1 + random() % 6; n > 0; --n) {
      const std::size_t event = random() % drive_.size();
      const std::size_t field = random() % 2 == 0 ? random() % 4 : 20 + random() % 8;
      bytes[offsets_[event] + field] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    write_bytes(log_, bytes);
    const Recovery r = recover(log_, types(), out_);
    ASSERT_EQ(verify(out_, types()).finding_count, 0U);
    ASSERT_EQ(read_with_lcm(out_).size(), r.events);
    ASSERT_GE(r.events, drive_.size() - 6);
  }
}

}  // namespace
}  // namespace maploop::lcm_log
