#include "ppp/filter/code_levels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace maploop::ppp {
namespace {

constexpr Satellite seen{System::gps, 1}, reflected{System::gps, 2}, risen{System::galileo, 7};

// Adds one epoch per second of six satellites, one of which has residuals with this `ratio`.
void epochs(CodeLevels& levels, int count, double ratio) {
  for (int i = 0; i < count; ++i) {
    for (std::uint8_t s = 1; s <= 6; ++s) {
      levels.add({System::gps, s}, s == reflected.number ? ratio : 0.2);
    }
    levels.end_epoch(1.0, 100.0);
  }
}

TEST(CodeLevels, GoodCodesAreAsGoodAsExpectedAndNoBetter) {
  CodeLevels levels;
  epochs(levels, 500, 0.1);
  EXPECT_EQ(levels.of(seen), 1.0);
  EXPECT_EQ(levels.of(reflected), 1.0);
  EXPECT_EQ(levels.of(risen), 1.0);
}

TEST(CodeLevels, ALargeResidualIsItsSatellitesOwnAndRemembered) {
  CodeLevels levels;
  epochs(levels, 500, 50.0);
  EXPECT_NEAR(levels.of(reflected), 50.0, 1.0);
  EXPECT_EQ(levels.of(seen), 1.0);
  epochs(levels, 100, 0.2);
  EXPECT_NEAR(levels.of(reflected), 50.0 * std::exp(-1.0), 1.0);
}

TEST(CodeLevels, ASatelliteThatRisesBeginsAsTheOthersAre) {
  CodeLevels levels;
  epochs(levels, 500, 50.0);
  EXPECT_NEAR(levels.of(risen), (50.0 + 5 * 0.2) / 6.0, 0.3);
  levels.begin(20.0);
  EXPECT_EQ(levels.of(risen), 20.0);
  EXPECT_EQ(levels.of(reflected), 20.0);
}

TEST(CodeLevels, OneOutlierHasALimitedEffect) {
  CodeLevels levels;
  epochs(levels, 1, 1e9);
  EXPECT_LT(levels.of(reflected), 3.0);
}

}  // namespace
}  // namespace maploop::ppp
