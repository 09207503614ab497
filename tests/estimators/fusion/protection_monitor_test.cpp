// These tests cover the protection levels of the fused position.
#include "estimators/fusion/protection_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/road_feedback.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/broken_archives.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

constexpr double speed = 10.0;       // m/s, to the north
constexpr double factor = 3.890592;  // of a risk of 1e-4

// Is the state of a car that has fixes, wheels and odometry, and which fixes pull to the east by
// `pulled` (m).
FusedState driving(double t, double pulled = 0.0) {
  FusedState s;
  s.status = s.odom.status = NavStatus::aided;
  s.stamp = s.odom.stamp = s.gnss_stamp = s.odometry_stamp = SyntheticDrive::at(t);
  s.position_enu = {pulled, speed * t, 0.0};
  s.odom.position = {-speed * t, 0.0, 0.0};  // odometry began with the car to the west
  s.odom.attitude.azimuth = -0.5 * std::numbers::pi;
  s.velocity_enu = {0.0, speed, 0.0};
  s.forward_speed = speed;
  s.covariance.diagonal().setConstant(1e-8);
  s.covariance(0, 0) = s.covariance(1, 1) = 1.0;
  return s;
}

class Protection : public ::testing::Test {
 protected:
  // Goes on to `until` (s); `change` may spoil each state.
  template <class Change>
  NavProtection run(double until, Change change) {
    NavProtection levels;
    for (; t_ <= until; t_ += 0.1) {
      FusedState state = driving(t_);
      change(state, t_);
      levels = monitor_.levels(state, filter_);
    }
    return levels;
  }
  NavProtection run(double until) {
    return run(until, [](FusedState&, double) {});
  }

  double t_ = 0.0;
  ProtectionMonitor monitor_;
  GuardedFilter filter_{started_filter(configured("GNSS+RISS"))};
};

TEST_F(Protection, WithoutAnyOtherPositionIsThatOfTheCovariance) {
  const NavProtection levels = run(0.0);
  EXPECT_EQ(levels.risk, 1e-4);
  EXPECT_NEAR(levels.along, factor * std::sqrt(2.0 + 0.25), 1e-3);
  EXPECT_NEAR(levels.across, levels.along, 1e-9);
  EXPECT_GT(levels.horizontal, std::hypot(levels.along, levels.across));
  EXPECT_FALSE(levels.without_map.known);
  EXPECT_FALSE(levels.without_gnss.known);
  EXPECT_FALSE(levels.without_odometry.known);
}

TEST_F(Protection, GrowsWithTheWayWithoutAFix) {
  run(1.0);
  const NavProtection levels =
      run(61.0, [](FusedState& s, double) { s.gnss_stamp = SyntheticDrive::at(0.95); });
  EXPECT_NEAR(levels.along, factor * std::sqrt(2.0 + 0.25 + 36.0), 0.1);
}

TEST_F(Protection, OfWrongFixesContainsWhereOdometryWouldBe) {
  const NavProtection right = run(40.0);
  ASSERT_TRUE(right.without_gnss.known);
  EXPECT_LT(right.without_gnss.across, 1e-6) << "though odometry has other axes";
  EXPECT_LT(right.without_gnss.along, 1e-6);

  const auto pulled = [](double t) { return 0.5 * std::max(0.0, t - 40.0); };
  const NavProtection wrong =
      run(60.0, [&](FusedState& s, double t) { s.position_enu.x() = pulled(t); });
  EXPECT_NEAR(wrong.without_gnss.across, pulled(60.0), 0.1);
  EXPECT_GT(wrong.across, pulled(60.0));
  EXPECT_LT(wrong.along, right.along + 0.5) << "only to the side";
}

TEST_F(Protection, OfWrongFixesIsNotKnownWithoutOdometryOrAfterARestart) {
  run(40.0);
  EXPECT_FALSE(run(42.0, [](FusedState& s, double) {
                 s.odometry_stamp = SyntheticDrive::at(40.0);
               }).without_gnss.known);
  EXPECT_TRUE(run(80.0).without_gnss.known);
  EXPECT_FALSE(
      run(80.2, [](FusedState& s, double) { s.reinitializations = 1; }).without_gnss.known);
}

TEST_F(Protection, OfALostAzimuthIsWide) {
  const NavProtection levels = run(40.0, [](FusedState& s, double) {
    s.covariance(6, 6) = 0.01;  // 0.1 rad over 300 m
  });
  EXPECT_NEAR(levels.without_gnss.across_sigma, std::sqrt(2.0 * (1.0 + 900.0) + 0.25 + 9.0), 2.0);
}

TEST_F(Protection, OfAVehicleThatStandsIsThatOfTheLargerAxis) {
  const NavProtection levels = run(0.0, [](FusedState& s, double) {
    s.velocity_enu.setZero();
    s.forward_speed = 0.0;
    s.covariance(0, 0) = 9.0;
  });
  EXPECT_EQ(levels.along, levels.across);
  EXPECT_NEAR(levels.along, factor * std::sqrt(18.25), 1e-2);
}

TEST_F(Protection, ContainsWhereTheFixesAre) {
  const auto state = filter_.aided().state_at(filter_.aided().newest());
  ASSERT_TRUE(state);
  GnssFix fix;
  fix.stamp = fix.velocity_stamp = state->stamp;
  fix.position_covariance = Eigen::Matrix3d::Identity();
  const auto note = [&](double to_the_east) {
    fix.position = filter_.aided().frame().to_geodetic(
        state->position_enu +
        rotation_enu_body(state->attitude) *
            Eigen::Vector3d(filter_.aided().parameters().gnss_lever_forward,
                            filter_.aided().parameters().gnss_lever_left,
                            filter_.aided().parameters().gnss_lever_up) +
        Eigen::Vector3d(to_the_east, 0.0, 0.0));
    monitor_.note(fix, filter_.aided());
  };
  for (const double east : {20.0, 20.0, 500.0}) note(east);
  const NavProtection levels = monitor_.levels(*state, filter_);
  ASSERT_TRUE(levels.without_odometry.known);
  const Separation& s = levels.without_odometry;
  EXPECT_NEAR(std::hypot(s.along, s.across), 20.0, 0.1) << "the median";
  EXPECT_GT(levels.horizontal, 20.0);
}

TEST_F(Protection, GoesOnFromAnArchive) {
  run(45.0);
  const auto bytes = saved(monitor_);
  EXPECT_LT(bytes.size(), monitor_.largest_archive());
  ProtectionMonitor resumed;
  load(bytes, resumed);
  const FusedState next = driving(45.1, 3.0);
  EXPECT_EQ(resumed.levels(next, filter_).across, monitor_.levels(next, filter_).across);
  expect_refuses_broken(bytes, resumed);
}

TEST(ProtectionParameters, AreChecked) {
  ProtectionParameters p;
  p.integrity_risk = 0.0;
  EXPECT_THROW(ProtectionMonitor{p}, std::invalid_argument);
}

}  // namespace
}  // namespace maploop::fusion
