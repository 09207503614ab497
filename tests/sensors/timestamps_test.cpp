#include "sensors/replay/timestamps.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace maploop::sensors {
namespace {

using ::testing::HasSubstr;

Timestamps parse(const std::string& text) {
  return parse_timestamps(text, "stamps.txt");
}

// Returns the frames that remain of stamps given in seconds.
std::vector<std::size_t> remaining(const std::vector<int>& seconds) {
  std::vector<Time> stamps;
  for (const int s : seconds) stamps.push_back(Time(std::chrono::seconds(s)));
  Verdicts verdicts(stamps.size());
  refuse_out_of_order(stamps, "stamps.txt", verdicts);
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (!verdicts[i]) result.push_back(i);
  }
  return result;
}

using Frames = std::vector<std::size_t>;

TEST(Timestamps, ReadsNanosecondsAsUtc) {
  const Timestamps t = parse("2011-09-26 13:10:51.174740992\n2011-09-26 13:10:51.278236416\n");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(to_nanoseconds(t.stamps[0]), 1317042651174740992);
  EXPECT_EQ(to_nanoseconds(t.stamps[1]), 1317042651278236416);
  EXPECT_FALSE(t.verdicts[0]);
}

TEST(Timestamps, AcceptsFewerDigitsCrlfAndTrailingBlankLines) {
  const Timestamps t = parse("2011-09-26 13:10:51.17\r\n2011-09-26 13:10:52\r\n\r\n  \n\n");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(to_nanoseconds(t.stamps[0]), 1317042651170000000);
  EXPECT_EQ(to_nanoseconds(t.stamps[1]), 1317042652000000000);
  EXPECT_FALSE(t.verdicts[0] || t.verdicts[1]);
}

TEST(Timestamps, ReadsALastLineWithoutItsEnd) {
  EXPECT_EQ(parse("2011-09-26 13:10:51").size(), 1U);
}

TEST(Timestamps, NamesALineThatIsNotAStampAndKeepsItsNumber) {
  const Timestamps t = parse(
      "2011-09-26 13:10:51.1\n\n2011-09-31 13:10:51.2\n9011-09-26 13:10:51.3\n"
      "2011-09-26 13:10:51.4\n");
  ASSERT_EQ(t.size(), 5U);
  EXPECT_FALSE(t.verdicts[0]);
  for (const std::size_t bad : {1U, 2U, 3U}) {
    ASSERT_TRUE(t.verdicts[bad]);
    EXPECT_EQ(t.verdicts[bad]->file, "stamps.txt");
    EXPECT_EQ(t.verdicts[bad]->line, bad + 1);
    EXPECT_THAT(t.verdicts[bad]->reason, HasSubstr("not a time stamp"));
  }
  EXPECT_FALSE(t.verdicts[4]);
}

TEST(Timestamps, RefusesATextWithoutAnyStamp) {
  for (const char* text : {"", "\n\r\n", "no stamp here\n"}) {
    EXPECT_THROW(parse(text), std::runtime_error) << text;
  }
}

TEST(TimeOrder, LeavesOutAsFewAsNeeded) {
  EXPECT_EQ(remaining({1, 2, 3}), (Frames{0, 1, 2}));
  EXPECT_EQ(remaining({1, 2, 2, 3}), (Frames{0, 1, 3})) << "of a repeated stamp the first stays";
  EXPECT_EQ(remaining({1, 3, 2, 4}), (Frames{0, 1, 3})) << "of two swapped stamps the first stays";
  EXPECT_EQ(remaining({1, 2, 900, 3, 4, 5}), (Frames{0, 1, 3, 4, 5})) << "one far ahead";
  EXPECT_EQ(remaining({11, 12, 0, 13, 14}), (Frames{0, 1, 3, 4})) << "one far behind";
  EXPECT_EQ(remaining({5, 4, 3, 2, 1}), (Frames{0})) << "reversed";
}

TEST(TimeOrder, OfStampsHoursApartTheLongestPartStays) {
  constexpr int hours = 3600;
  EXPECT_EQ(remaining({1, 2, 3, 3 + hours}), (Frames{0, 1, 2, 3})) << "not more than an hour";
  EXPECT_EQ(remaining({1, 2, 3, 4 + hours}), (Frames{0, 1, 2})) << "at the end";
  EXPECT_EQ(remaining({1, 2 * hours, 2 * hours + 1}), (Frames{1, 2})) << "at the begin";
  EXPECT_EQ(remaining({1, 2, 30 * hours, 30 * hours + 1}), (Frames{0, 1})) << "the earliest of two";
}

TEST(TimeOrder, APauseOfLessThanADayKeepsBothParts) {
  constexpr int hours = 3600;
  EXPECT_EQ(remaining({1, 2, 3, 9 * hours, 9 * hours + 1}), (Frames{0, 1, 2, 3, 4}));
  EXPECT_EQ(remaining({1, 2, 9 * hours, 9 * hours + 1, 9 * hours + 2}), (Frames{0, 1, 2, 3, 4}));
  EXPECT_EQ(remaining({1, 2, 9 * hours, 12 * hours, 12 * hours + 1}), (Frames{0, 1, 3, 4}))
      << "a single stamp between is not believed";
}

TEST(Timestamps, OfMoreFramesThanARecordingHasAreRefused) {
  EXPECT_THROW(parse("2011-09-26 13:10:51\n" + std::string(3'000'000, '\n') + "x"),
               std::runtime_error);
}

TEST(TimeOrder, DoesNotTouchFramesAlreadyRefused) {
  const std::vector<Time> stamps{Time(Duration(1)), Time(Duration(0)), Time(Duration(2))};
  Verdicts verdicts(3);
  verdicts[1] = Finding{"other.txt", 7, "before"};
  refuse_out_of_order(stamps, "stamps.txt", verdicts);
  EXPECT_FALSE(verdicts[0] || verdicts[2]);
  EXPECT_EQ(verdicts[1]->reason, "before");
}

// The result is compared with every subsequence of short random lists.
TEST(TimeOrder, KeepsAsManyAsThereAre) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    std::vector<int> seconds(9);
    for (int& s : seconds) s = static_cast<int>(random() % 8);
    std::size_t longest = 0;
    for (unsigned mask = 0; mask < 512; ++mask) {
      int last = -1;
      std::size_t length = 0;
      bool increasing = true;
      for (std::size_t i = 0; i < 9; ++i) {
        if ((mask >> i & 1U) == 0) continue;
        increasing = increasing && seconds[i] > last;
        last = seconds[i];
        ++length;
      }
      if (increasing) longest = std::max(longest, length);
    }
    const Frames kept = remaining(seconds);
    EXPECT_EQ(kept.size(), longest);
    for (std::size_t i = 1; i < kept.size(); ++i) {
      EXPECT_LT(seconds[kept[i - 1]], seconds[kept[i]]);
    }
  }
}

}  // namespace
}  // namespace maploop::sensors
