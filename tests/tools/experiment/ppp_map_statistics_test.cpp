// Tests the statistics of the map's experiment with PPP, on parts made by hand.
#include "tools/experiment/ppp_map_statistics.h"

#include <gtest/gtest.h>

namespace maploop::experiments {
namespace {

const Chosen all = [](const PppMoment&) { return true; };

// Returns constant errors across at 1 Hz, without and with the map.
Part part_of(double without, double with, int seconds) {
  Part part;
  for (int i = 0; i < seconds; ++i) {
    PppMoment m;
    m.time = i;
    m.moves = true;
    m.across_free = without;
    m.across_aided = with;
    part.push_back(m);
  }
  return part;
}

TEST(PppMapStatistics, EqualPartsHaveNoSpread) {
  const Reduction r = reduction({part_of(1.0, 0.6, 10), part_of(-1.0, 0.6, 10)}, true, all);
  EXPECT_EQ(r.parts, 2U);
  EXPECT_EQ(r.moments, 20U);
  EXPECT_NEAR(r.without, 1.0, 1e-12);
  EXPECT_NEAR(r.percent, 40.0, 1e-9);
  EXPECT_NEAR(r.low, 40.0, 1e-9);
  EXPECT_NEAR(r.high, 40.0, 1e-9);
}

TEST(PppMapStatistics, PartsThatDisagreeHaveAWideInterval) {
  std::vector<Part> parts;
  for (int i = 0; i < 10; ++i) parts.push_back(part_of(1.0, i % 2 == 0 ? 0.5 : 1.5, 10));
  const Reduction r = reduction(parts, true, all);
  EXPECT_LT(r.percent, 0.0);
  EXPECT_LT(r.low, r.percent - 10.0);
  EXPECT_GT(r.high, r.percent + 10.0);
}

TEST(PppMapStatistics, NothingChosenIsNothing) {
  const Reduction r = reduction({part_of(1, 1, 5)}, false, [](const PppMoment&) { return false; });
  EXPECT_EQ(r.moments, 0U);
  EXPECT_EQ(r.percent, 0.0);
}

TEST(PppMapStatistics, TheTimeIsThatOfTheLastErrorBeyondTheLimit) {
  Part part = part_of(0.5, 0.5, 60);
  part[30].across_free = part[10].across_aided = -2.0;
  const TimeToStay t = time_to_stay({part}, 1.5, 5.0, all);
  EXPECT_EQ(t.without, 25.0);
  EXPECT_EQ(t.with, 5.0);
  EXPECT_NEAR(t.percent, 80.0, 1e-9);
}

TEST(PppMapStatistics, RecoveryLooksTenSecondsAfterAPauseBegins) {
  Part part = part_of(0.5, 0.5, 60);
  for (std::size_t i = 20; i < 40; ++i) part[i].paused = true;
  part[20].apart = 3.0;
  part[30].apart = 0.25;
  part[59].restorations = 1;
  const Recovery r = recovery({part});
  EXPECT_EQ(r.pauses, 1U);
  EXPECT_EQ(r.restorations, 1U);
  EXPECT_EQ(r.farthest, 0.25);
}

TEST(PppMapStatistics, ALongPartIsCutIntoDraws) {
  const auto draws = cut_into(part_of(1.0, 0.5, 100), 30.0);
  ASSERT_EQ(draws.size(), 4U);
  EXPECT_EQ(draws[0].size(), 30U);
  EXPECT_EQ(draws[3].size(), 10U);
}

}  // namespace
}  // namespace maploop::experiments
