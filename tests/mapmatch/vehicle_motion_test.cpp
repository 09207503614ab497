#include "mapmatch/vehicle_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

// Returns the motion after driving straight north at 10 m/s with errors of `white` m that are new
// at each fix, and a constant error.
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

TEST(VehicleMotion, AStandingVehicleHasNoAzimuthWhateverItsFixesDo) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const bool told : {true, false}) {
    VehicleMotion motion;
    Eigen::Vector2d error(5.0, -5.0);  // changes slowly, as under trees
    double way = 0.0;
    int directed = 0;
    for (int i = 0; i < 120; ++i) {
      VehicleFix fix;
      fix.stamp = Time(from_seconds(100.0 + i));
      fix.covariance = 25.0 * Eigen::Matrix2d::Identity();
      if (told) fix.speed = 0.0;
      error = 0.967 * error + 1.27 * Eigen::Vector2d(normal(random), normal(random));
      const Motion last = motion.add(fix, error, {});
      if (i < 20) continue;
      way += last.distance;
      directed += std::isfinite(last.azimuth) ? 1 : 0;
    }
    EXPECT_EQ(directed, 0) << told;
    EXPECT_LT(way, told ? 1e-9 : 40.0);
  }
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

// Returns the motion while turning right at 20 degrees per second for 9 s; visual odometry measures
// `visual` degrees per second, and nothing at `dark` s.
Motion seen_turning(int rate, double visual, double dark = -1.0) {
  VehicleMotion motion;
  Motion last;
  for (int i = 0; i <= 9 * rate; ++i) {
    VehicleFix fix;
    const double t = static_cast<double>(i) / rate;
    fix.stamp = Time(from_seconds(t));
    fix.speed = 5.0;
    fix.azimuth = wrap_angle(radians(170.0 + 20.0 * t));
    fix.azimuth_sigma = radians(0.5);
    if (std::abs(t - dark) > 1e-3) {
      fix.visual_speed = 5.2;
      fix.visual_azimuth = wrap_angle(radians(-60.0 + visual * t));
    }
    last = motion.add(fix, {0.0, 0.0}, {});
  }
  return last;
}

TEST(VehicleMotion, VisualTurnsAreOfOneSecondAtEveryRate) {
  for (const int rate : {1, 5, 10}) {
    const Motion motion = seen_turning(rate, 21.0);
    EXPECT_NEAR(degrees(motion.visual_turn), 21.0, 0.1) << rate;
    EXPECT_NEAR(degrees(motion.visual_reversal), 126.0, 0.1) << rate;
    EXPECT_EQ(motion.visual_speed, 5.2) << rate;
  }
}

TEST(VehicleMotion, ImagesThatContradictTheFixesAreNoWitness) {
  EXPECT_TRUE(std::isfinite(seen_turning(10, 17.5).visual_turn)) << "2.5 degrees";
  const Motion motion = seen_turning(10, 16.5);
  EXPECT_TRUE(std::isnan(motion.visual_turn)) << "3.5 degrees";
  EXPECT_TRUE(std::isnan(motion.visual_speed));
}

TEST(VehicleMotion, NoVisualTurnIsTakenAcrossABreak) {
  EXPECT_TRUE(std::isnan(seen_turning(10, 20.0, 8.5).visual_turn));
  EXPECT_TRUE(std::isfinite(seen_turning(10, 20.0, 7.5).visual_turn));
  EXPECT_TRUE(std::isnan(seen_turning(10, 20.0, 7.5).visual_reversal));
}

}  // namespace
}  // namespace maploop::mapmatch
