#include "estimators/fusion/stamp_guard.h"

#include <gtest/gtest.h>

#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

const auto at = maploop::testing::SyntheticDrive::at;

TEST(StampGuard, TakesTheFirstStampAndWhatLiesNearIt) {
  StampGuard guard({});
  EXPECT_EQ(guard.check(at(100.0)), Reason::none);
  guard.accept(at(100.0));
  EXPECT_EQ(guard.check(at(98.5)), Reason::none);
  EXPECT_EQ(guard.check(at(96.5)), Reason::too_old);
  EXPECT_EQ(guard.check(at(101.0)), Reason::none);
  EXPECT_EQ(guard.check(Time{}), Reason::out_of_range);
  guard.accept(at(99.0));
  EXPECT_EQ(guard.newest(), at(100.0));
}

TEST(StampGuard, AGapNeedsASecondStampThatAgrees) {
  StampGuard guard({});
  guard.accept(at(100.0));
  EXPECT_EQ(guard.check(at(103.0)), Reason::time_jump);
  EXPECT_EQ(guard.check(at(103.01)), Reason::none);
  guard.accept(at(100.01));
  EXPECT_EQ(guard.check(at(103.02)), Reason::time_jump) << "all is well again in between";
  EXPECT_EQ(guard.check(at(110.0)), Reason::time_jump);
  EXPECT_EQ(guard.check(at(110.01)), Reason::time_jump) << "beyond what is bridged";
}

TEST(StampGuard, NothingButRefusalsIsAJumpOfTheClock) {
  FusionParameters parameters;
  parameters.restart_after = 3;
  StampGuard guard(parameters);
  guard.accept(at(100.0));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_FALSE(guard.refuse(Reason::duplicate));
  EXPECT_FALSE(guard.refuse(Reason::time_jump));
  guard.accept(at(100.1));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_FALSE(guard.refuse(Reason::too_old));
  EXPECT_TRUE(guard.refuse(Reason::too_old));
  guard.reset();
  EXPECT_EQ(guard.check(at(5.0)), Reason::none);
}

}  // namespace
}  // namespace maploop::fusion
