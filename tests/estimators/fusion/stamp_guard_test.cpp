#include "estimators/fusion/stamp_guard.h"

#include <gtest/gtest.h>

#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using maploop::testing::SyntheticDrive;

TEST(StampGuard, TakesTheFirstStampAndWhatLiesNearIt) {
  StampGuard guard({});
  EXPECT_EQ(guard.check(SyntheticDrive::at(100.0)), Reason::none);
  guard.accept(SyntheticDrive::at(100.0));
  EXPECT_EQ(guard.check(SyntheticDrive::at(98.5)), Reason::none);
  EXPECT_EQ(guard.check(SyntheticDrive::at(96.5)), Reason::too_old);
  EXPECT_EQ(guard.check(SyntheticDrive::at(101.0)), Reason::none);
  EXPECT_EQ(guard.check(Time{}), Reason::out_of_range);
  guard.accept(SyntheticDrive::at(99.0));
  EXPECT_EQ(guard.newest(), SyntheticDrive::at(100.0));
}

TEST(StampGuard, AGapNeedsASecondStampThatAgrees) {
  StampGuard guard({});
  guard.accept(SyntheticDrive::at(100.0));
  EXPECT_EQ(guard.check(SyntheticDrive::at(103.0)), Reason::time_jump);
  EXPECT_EQ(guard.check(SyntheticDrive::at(103.01)), Reason::none);
  guard.accept(SyntheticDrive::at(100.01));
  EXPECT_EQ(guard.check(SyntheticDrive::at(103.02)), Reason::time_jump)
      << "all is well again in between";
  EXPECT_EQ(guard.check(SyntheticDrive::at(110.0)), Reason::time_jump);
  EXPECT_EQ(guard.check(SyntheticDrive::at(110.01)), Reason::time_jump) << "beyond what is bridged";
}

// Returns which of the stamps are accepted.
std::vector<bool> accepted(const std::vector<double>& seconds) {
  StampGuard guard({});
  std::vector<bool> all;
  for (const double s : seconds) {
    all.push_back(guard.check(SyntheticDrive::at(s)) == Reason::none);
    if (all.back()) guard.accept(SyntheticDrive::at(s));
  }
  return all;
}

TEST(StampGuard, RareDataIsTakenFromTheThirdStampOn) {
  using Accepted = std::vector<bool>;
  EXPECT_EQ(accepted({100.0, 101.01, 102.0, 103.02, 104.0, 105.3}),
            (Accepted{true, false, true, true, true, true}));
  EXPECT_EQ(accepted({100, 102, 104.1, 106, 108, 110}),
            (Accepted{true, false, true, true, true, true}));
  EXPECT_EQ(accepted({100, 102, 104, 106, 110, 112, 114}),
            (Accepted{true, false, true, true, false, true, true}))
      << "one is missing";
  EXPECT_EQ(accepted({100, 103, 106, 109}), (Accepted{true, false, false, false}))
      << "the filter does not find its way over so long a gap";
}

TEST(StampGuard, AWrongStampOfRareDataIsRefusedAlone) {
  EXPECT_EQ(accepted({100, 102, 104, 106, 150, 108, 110}),
            (std::vector<bool>{true, false, true, true, false, true, true}));
}

TEST(StampGuard, AClockThatIsSetByDecadesIsNoRhythm) {
  StampGuard guard({});
  const auto year = [](int y) { return Time(std::chrono::sys_days(std::chrono::year(y) / 1 / 1)); };
  for (const int y : {2015, 2026, 2045, 2080}) {
    guard.accept(year(1971));
    EXPECT_EQ(guard.check(year(y)), Reason::time_jump) << y;
    EXPECT_EQ(guard.check(year(y) + std::chrono::milliseconds(10)), Reason::time_jump) << y;
    guard.reset();
  }
}

TEST(StampGuard, NothingButRefusalsIsAJumpOfTheClock) {
  FusionParameters parameters;
  parameters.restart_after = 3;
  StampGuard guard(parameters);
  guard.accept(SyntheticDrive::at(100.0));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_FALSE(guard.refuse(Reason::duplicate));
  EXPECT_FALSE(guard.refuse(Reason::time_jump));
  guard.accept(SyntheticDrive::at(100.1));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_TRUE(guard.refuse(Reason::too_old));
  guard.reset();
  EXPECT_EQ(guard.check(SyntheticDrive::at(5.0)), Reason::none);
}

}  // namespace
}  // namespace maploop::fusion
