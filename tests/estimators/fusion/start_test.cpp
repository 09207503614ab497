// The filter starts at the first fix that moves; before it, a slow fix gives the place alone.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

TEST(Start, WaitsForAFixThatMovesAndKeepsWhatArrivesMeanwhile) {
  MotionProfile pull_away;
  pull_away.speed = [](double t) { return t < 20.0 ? 0.0 : 0.5 * (t - 20.0); };
  const SyntheticDrive drive(pull_away, 40.0, test_origin());
  const std::vector<ImuSample> imu = drive.imu(100.0);
  ReducedImuFilter filter({}, test_origin());
  EXPECT_EQ(filter.status().phase, Phase::waiting_for_fix);
  EXPECT_FALSE(filter.state_at(drive.at(0.0)));
  int started_at = -1;
  for (int second = 0; second < 40 && started_at < 0; ++second) {
    for (std::size_t i = 0; i < 100; ++i) {
      const ImuSample& s = imu[100 * static_cast<std::size_t>(second) + i];
      EXPECT_EQ(filter.add(s), (Outcome{Disposition::held, Reason::none}));
    }
    const Outcome outcome = filter.add(drive.fix(second));
    if (outcome.refused()) {
      EXPECT_EQ(outcome.reason, Reason::no_course);
      EXPECT_EQ(filter.status().phase, Phase::waiting_for_motion);
      const auto state = filter.state_without_course_at(drive.at(second + 0.5));
      ASSERT_TRUE(state);
      const Eigen::Vector3d place = drive.pose(second + 0.5).translation();
      EXPECT_LT((state->position_enu - place).norm(), 1.5) << second;
    } else {
      started_at = second;
    }
  }
  EXPECT_EQ(started_at, 24);
  EXPECT_FALSE(filter.state_without_course_at(filter.newest())) << "it has a course now";
  EXPECT_EQ(filter.status().phase, Phase::running);
  EXPECT_GT(filter.status().unused, 2000u) << "samples too old when it started";
  const NavState nav = *filter.state_at(filter.newest());
  EXPECT_EQ(nav.imu_stamp, imu[2499].stamp) << "held samples were applied";
  EXPECT_NEAR(nav.forward_speed, 2.5, 0.05);
}

TEST(Start, ASlowFixShowsThePlaceButNoDirection) {
  FusionParameters parameters;
  parameters.gnss_lever_forward = 3.0;
  parameters.gnss_lever_left = 4.0;
  parameters.gnss_lever_up = 1.5;
  ReducedImuFilter filter(parameters);
  GnssFix fix;
  fix.stamp = fix.velocity_stamp = fix.available = parse_time("2011-09-30 12:00:00");
  fix.position = test_origin();
  fix.velocity_enu = {0.5, 0.0, 0.0};
  fix.position_covariance = 4.0 * Eigen::Matrix3d::Identity();
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(filter.add(fix).reason, Reason::no_course);
  EXPECT_FALSE(filter.state_at(fix.stamp));
  EXPECT_FALSE(filter.state_without_course_at(fix.stamp - std::chrono::milliseconds(1)));
  const FusedState now = filter.state_without_course_at(fix.stamp).value();
  EXPECT_EQ(now.status, NavStatus::without_course);
  EXPECT_EQ(now.odom.status, NavStatus::uninitialized);
  EXPECT_EQ(now.gnss_stamp, fix.stamp);
  EXPECT_EQ(now.origin, test_origin());
  EXPECT_NEAR((now.position_enu - Eigen::Vector3d(0.0, 0.0, -1.5)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(now.covariance(0, 0), 4.0 + 0.5 * 25.0, 0.1) << "the antenna may be on any side";
  EXPECT_NEAR(now.covariance(2, 2), 4.0, 0.1);
  EXPECT_GT(now.covariance(6, 6), 3.0) << "rad^2: any direction";
  const FusedState later =
      filter.state_without_course_at(fix.stamp + std::chrono::seconds(2)).value();
  EXPECT_NEAR(later.position_enu.x(), 1.0, 1e-6);
  EXPECT_GT(later.covariance(0, 0), now.covariance(0, 0) + 30.0) << "it may have driven off";
  EXPECT_FALSE(filter.state_without_course_at(fix.stamp + std::chrono::seconds(6)));
}

// As from a receiver without Doppler shifts.
TEST(Start, AnUncertainVelocityStartsTheAzimuthIfNoBetterOneComes) {
  const FusionParameters parameters;
  ReducedImuFilter filter(parameters, test_origin());
  const auto fix_of_speed = [](double t, double speed) {
    GnssFix fix;
    fix.stamp = fix.velocity_stamp = SyntheticDrive::at(t);
    fix.position = test_origin();
    fix.velocity_enu = {speed, 0.0, 0.0};
    fix.position_covariance = Eigen::Matrix3d::Identity();
    fix.velocity_covariance = 1.2 * 1.2 * Eigen::Matrix3d::Identity();
    return fix;
  };
  const double patience = parameters.late_course_after;
  for (double t = -60.0; t < 0.0; t += 1.0)
    EXPECT_EQ(filter.add(fix_of_speed(t, 0.5)).reason, Reason::no_course) << "it stands";
  for (double t = 0.0; t < patience; t += 1.0)
    EXPECT_EQ(filter.add(fix_of_speed(t, 8.0)).reason, Reason::no_course) << t;
  EXPECT_EQ(filter.add(fix_of_speed(patience, 4.0)).reason, Reason::no_course) << "17 degrees";
  EXPECT_EQ(filter.add(fix_of_speed(patience + 1.0, 8.0)).reason, Reason::none);
  const FusedState state = filter.state_at(SyntheticDrive::at(patience + 1.0)).value();
  EXPECT_NEAR(state.attitude.azimuth, radians(90.0), 0.01);
  EXPECT_NEAR(std::sqrt(state.covariance(6, 6)), 1.2 / 8.0, 0.03);
}

TEST(Start, IsRefusedFarFromAGivenOrigin) {
  Geodetic origin = test_origin();
  origin.latitude += radians(1.0);
  ReducedImuFilter filter({}, origin);
  EXPECT_EQ(filter.add(SyntheticDrive({}, 1.0, test_origin()).fix(0.0)),
            refused(Reason::too_far_from_origin));
}

}  // namespace
}  // namespace maploop::fusion
