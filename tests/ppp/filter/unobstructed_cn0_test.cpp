#include "ppp/filter/unobstructed_cn0.h"

#include <gtest/gtest.h>

#include <random>

namespace maploop::ppp {
namespace {

constexpr double zenith = 1.0, half_way = 0.5;  // sines: 90 and 30 degrees

// Adds `count` signals with this mean strength and a standard deviation of 2 dB.
void signals(UnobstructedCn0& strength, double sine, double mean, int count) {
  std::mt19937 random(1);
  std::normal_distribution<double> cn0(mean, 2.0);
  for (int i = 0; i < count; ++i) strength.add(sine, cn0(random));
}

TEST(UnobstructedCn0, StartsWithTheCurveOfAllReceivers) {
  const UnobstructedCn0 strength{PppParameters{}};
  EXPECT_DOUBLE_EQ(strength.of(zenith), 47.0);
  EXPECT_DOUBLE_EQ(strength.of(half_way), 47.0 - 14.5 / 2.0);
}

TEST(UnobstructedCn0, IsBelowTheUpperQuartileOfAStrongReceiver) {
  UnobstructedCn0 strength{PppParameters{}};
  signals(strength, half_way, 46.0, 2000);
  const double upper_quartile = 46.0 + 0.674 * 2.0;
  EXPECT_NEAR(strength.of(half_way), upper_quartile - 4.0, 0.5);
  EXPECT_DOUBLE_EQ(strength.of(zenith), 47.0);  // other elevations are unaffected
}

// The first positions of a drive between houses depend on it.
TEST(UnobstructedCn0, IsKnownAfterAFewSignals) {
  UnobstructedCn0 strength{PppParameters{}};
  for (int i = 0; i < 4; ++i) strength.add(half_way, 46.0);
  EXPECT_NEAR(strength.of(half_way), 46.0 - 4.0, 1.0);
}

// Between houses most signals are weak, but they must not count as unobstructed.
TEST(UnobstructedCn0, IsNotLoweredForAWeakReceiver) {
  UnobstructedCn0 strength{PppParameters{}};
  signals(strength, zenith, 35.0, 2000);
  EXPECT_DOUBLE_EQ(strength.of(zenith), 47.0);
}

TEST(UnobstructedCn0, IsNotLoweredByReflectedSignals) {
  UnobstructedCn0 strength{PppParameters{}};
  for (int i = 0; i < 1000; ++i) {
    strength.add(half_way, 46.0);
    strength.add(half_way, 30.0);
  }
  EXPECT_NEAR(strength.of(half_way), 46.0 - 4.0, 0.3);
}

TEST(UnobstructedCn0, IsZeroWhereStrengthIsNotUsed) {
  PppParameters parameters;
  parameters.full_cn0 = 0.0;
  UnobstructedCn0 strength{parameters};
  signals(strength, zenith, 45.0, 2000);
  EXPECT_EQ(strength.of(zenith), 0.0);
}

}  // namespace
}  // namespace maploop::ppp
