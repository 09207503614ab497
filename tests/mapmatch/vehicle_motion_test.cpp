#include "mapmatch/vehicle_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

// Straight north at 10 m/s with errors of `white` m that are new at each fix, and a constant one.
Motion after_a_minute(double white, double constant, double rate, bool told) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  VehicleMotion motion;
  Motion last;
  for (int i = 0; i <= 60 * static_cast<int>(rate); ++i) {
    VehicleFix fix;
    const double t = i / rate;
    fix.stamp = Time(from_seconds(100.0 + t));
    fix.covariance = (white * white + constant * constant) * Eigen::Matrix2d::Identity();
    if (told) {
      fix.speed = 10.0;
      fix.azimuth = 0.0;
    }
    last = motion.add(
        fix, {constant + white * normal(random), 10.0 * t - constant + white * normal(random)}, {});
  }
  return last;
}

TEST(VehicleMotion, TellsErrorsThatChangeFromThoseThatStay) {
  for (const double rate : {1.0, 10.0}) {
    EXPECT_GT(after_a_minute(8.0, 0.0, rate, true).white_share, 0.7) << rate;
    EXPECT_LT(after_a_minute(0.5, 8.0, rate, true).white_share, 0.15) << rate;
  }
}

TEST(VehicleMotion, SpeedAndAzimuthComeFromPositionsWhereTheyAreNotTold) {
  const Motion motion = after_a_minute(3.0, 0.0, 1.0, false);
  EXPECT_NEAR(motion.speed, 10.0, 2.5);
  EXPECT_LT(std::abs(motion.azimuth), radians(20.0));
  EXPECT_GT(motion.azimuth_sigma, radians(2.0));
}

TEST(VehicleMotion, TurnsAreChangesOfOneSecondAtEveryRateAndWrapped) {
  for (const int rate : {1, 5, 10}) {
    VehicleMotion motion;
    Motion last;
    for (int i = 0; i <= 8 * rate; ++i) {
      VehicleFix fix;
      const double t = static_cast<double>(i) / rate;
      fix.stamp = Time(from_seconds(t));
      fix.speed = 5.0;
      fix.azimuth = wrap_angle(radians(170.0 + 20.0 * t));
      fix.yaw_rate = -radians(20.0);
      last = motion.add(fix, {0.0, 0.0}, {});
    }
    EXPECT_NEAR(degrees(last.turn), 20.0, 0.1) << rate;
    EXPECT_NEAR(degrees(last.turn_rate), 20.0, 0.1) << rate;
    EXPECT_NEAR(degrees(last.reversal), 120.0, 0.1) << rate;
  }
}

}  // namespace
}  // namespace maploop::mapmatch
