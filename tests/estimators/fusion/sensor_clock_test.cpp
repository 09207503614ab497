#include "estimators/fusion/sensor_clock.h"

#include <gtest/gtest.h>

#include "estimators/fusion/stamp_guard.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using maploop::testing::SyntheticDrive;

Sample sample(std::uint64_t sequence, double stamp, double age) {
  Sample s;
  s.sequence = sequence;
  s.stamp = SyntheticDrive::at(stamp);
  s.available = SyntheticDrive::at(stamp + age);
  return s;
}

TEST(SensorClock, BelievesLateAndReorderedSamples) {
  SensorClock clock;
  EXPECT_EQ(clock.check(sample(1, 0.1, 0.06)), Reason::none);
  EXPECT_EQ(clock.check(sample(3, 0.3, 0.06)), Reason::none);
  EXPECT_EQ(clock.check(sample(2, 0.2, 0.26)), Reason::none);
  EXPECT_EQ(clock.check(sample(3, 0.3, 0.16)), Reason::none) << "a duplicate is another's business";
  EXPECT_EQ(clock.check(sample(4, 0.4, 1.06)), Reason::none) << "late, and in order";
}

TEST(SensorClock, RefusesAClockThatFellBackUntilItIsRightAgain) {
  SensorClock clock;
  for (std::uint64_t i = 0; i < 10; ++i) {
    ASSERT_EQ(clock.check(sample(i, 0.1 * static_cast<double>(i), 0.06)), Reason::none);
  }
  // The clock is one second back; samples are refused even after their stamps pass the last good
  // one.
  for (std::uint64_t i = 10; i < 40; ++i) {
    const double stamp = 0.1 * static_cast<double>(i) - 1.0;
    EXPECT_EQ(clock.check(sample(i, stamp, 1.06)), Reason::clock_fell_back) << i;
  }
  EXPECT_EQ(clock.check(sample(40, 4.0, 0.06)), Reason::none);
  EXPECT_EQ(clock.check(sample(41, 4.1, 0.06)), Reason::none);
}

TEST(SensorClock, BelievesAClockThatWasAheadForAWhileAndIsRightAgain) {
  for (const double ahead : {0.02, 0.05, 1.0}) {
    SensorClock clock;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const bool wrong = i >= 500 && i < 1500;  // for 10 s
      const double by = wrong ? ahead : 0.0;
      const double stamp = 0.01 * static_cast<double>(i) + by;
      EXPECT_EQ(clock.check(sample(i, stamp, 0.06 - by)), Reason::none) << ahead << ' ' << i;
    }
  }
}

TEST(SensorClock, SaysNothingWhereTheDeliveryIsUnknown) {
  SensorClock clock;
  Sample a = sample(1, 1.0, 0.0), b = sample(2, 0.5, 0.0);
  a.available = b.available = Time{};
  EXPECT_EQ(clock.check(a), Reason::none);
  EXPECT_EQ(clock.check(b), Reason::none);
}

}  // namespace
}  // namespace maploop::fusion
