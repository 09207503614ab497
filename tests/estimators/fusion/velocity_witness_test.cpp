// Tests what the velocities of fixes show of other aids: wheels of a wrong unit or sign, a ferry,
// and a start in reverse.
#include "estimators/fusion/velocity_witness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimators/fusion/wheel_check.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/estimators/fusion/town_drive.h"

namespace maploop::fusion {
namespace velocity_witness_test {

using namespace maploop::testing;
using namespace maploop::testing::town_drive;

GnssFix fix_of(double t, double speed, double sigma = 0.05) {
  GnssFix fix;
  fix.stamp = fix.velocity_stamp = SyntheticDrive::at(t);
  fix.velocity_enu = {0.6 * speed, 0.8 * speed, 0.0};
  fix.velocity_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
  fix.position_covariance = Eigen::Matrix3d::Identity();
  return fix;
}

WheelSpeed wheel_of(double t, double speed) {
  WheelSpeed w;
  w.stamp = SyntheticDrive::at(t);
  w.speed = speed;
  return w;
}

// Returns whether the wheels are taken to be wrong after `seconds` of fixes, two a second, whose
// positions move otherwise by `apart` of the way.
bool wrong_after(double seconds, double by_fix, double by_wheels, WheelCheck check = {},
                 const Eigen::Vector2d& apart = {0.0, 0.0}) {
  constexpr double sigma = 0.05;  // m/s
  for (double t = 0.0; t < seconds; t += 0.5) {
    check.add(wheel_of(t, by_wheels));
    check.compare(fix_of(t, by_fix, sigma), {0.5, 0.5 * by_fix, apart * 0.5 * by_fix}, 0.0);
  }
  return check.wrong;
}

TEST(WheelCheck, WheelsOfAWrongUnitOrSignOrThatStandAreWrong) {
  EXPECT_TRUE(wrong_after(10.0, 10.0, 36.0));
  EXPECT_TRUE(wrong_after(10.0, 10.0, 22.4));
  EXPECT_TRUE(wrong_after(10.0, 10.0, -10.0));
  EXPECT_TRUE(wrong_after(10.0, 10.0, 0.0));
}

TEST(WheelCheck, WornTyresAShortSlipAndReversingAreNotWrong) {
  EXPECT_FALSE(wrong_after(60.0, 10.0, 11.0));
  EXPECT_FALSE(wrong_after(60.0, 10.0, 9.0));
  EXPECT_FALSE(wrong_after(3.0, 10.0, 14.0));
  EXPECT_FALSE(wrong_after(60.0, 4.0, -4.0));
  EXPECT_FALSE(wrong_after(60.0, 4.0, 4.0));
}

TEST(WheelCheck, FixesThatAreSlowOrContradictThemselvesDoNotJudge) {
  EXPECT_FALSE(wrong_after(60.0, 0.0, 0.0));
  EXPECT_FALSE(wrong_after(60.0, 1.0, 2.5));
  EXPECT_FALSE(wrong_after(60.0, 10.0, 36.0, {}, {-0.6, -0.8}));  // they stay where they are
}

TEST(WheelCheck, WheelsThatAgreeAgainAreUsedAgain) {
  WheelCheck check;
  check.wrong = true;
  EXPECT_TRUE(wrong_after(3.0, 10.0, 10.0, check));
  EXPECT_FALSE(wrong_after(10.0, 10.0, 10.0, check));
}

// Runs a filter over a drive with fixes twice a second until `last_fix`, and wheels that read
// `wheels` times the speed. Returns the horizontal error at its end, m.
double end_error(const SyntheticDrive& drive, double duration, double last_fix, double wheels) {
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, duration, wheels - 1.0));
  for (double t = 0.0; t <= last_fix; t += 0.5) all.push_back(fix(drive, t));
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(duration - 1.0));
  return nav ? horizontal_error(*nav, drive, duration - 1.0) : 1e9;
}

TEST(WheelsOfAWrongUnit, LeaveThePositionToTheFixesAndAreNotBelievedInAnOutage) {
  const SyntheticDrive drive(town(), 80.0, test_origin());
  for (const double factor : {3.6, 2.24, -1.0, 0.0}) {
    SCOPED_TRACE(factor);
    EXPECT_LT(end_error(drive, 80.0, 79.0, factor), 1.0);
    // They said 300 m and more when they were believed again without fixes.
    EXPECT_LT(end_error(drive, 80.0, 60.0, factor), 40.0);
  }
  EXPECT_LT(end_error(drive, 80.0, 60.0, 1.02), 4.0);
}

TEST(WheelsOfAWrongUnit, AreNamed) {
  const SyntheticDrive drive(town(), 30.0, test_origin());
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 30.0, 2.6));
  for (double t = 0.0; t <= 30.0; t += 0.5) all.push_back(fix(drive, t));
  add_as_available(filter, all);
  EXPECT_GT(filter.status().refused_for(Reason::wheels_wrong), 150U);
}

TEST(Ferry, CarriesAStandingVehicleThatIsNotTakenToStand) {
  MotionProfile profile;
  profile.speed = [](double t) { return 5.0 * (1.0 - std::tanh((t - 20.0) / 4.0)); };
  const SyntheticDrive drive(profile, 120.0, test_origin());
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 120.0));
  constexpr double departs = 50.0;  // s
  const Eigen::Vector3d ferry(6.0, 0.0, 0.0);
  const LocalFrame frame(test_origin());
  for (double t = 0.0; t <= 120.0; t += 0.5) {
    GnssFix f = fix(drive, t);
    if (t > departs) {
      f.position = frame.to_geodetic(frame.to_enu(f.position) + (t - departs) * ferry);
      f.velocity_enu += ferry;
    }
    all.push_back(f);
    // A receiver that derives its velocities has none for most of its fixes.
    f.stamp = f.velocity_stamp = SyntheticDrive::at(t + 0.25);
    f.available = f.stamp + from_seconds(0.1);
    f.sequence += 1000;
    f.position = frame.to_geodetic(frame.to_enu(f.position) + 0.25 * f.velocity_enu);
    f.velocity_enu.setZero();
    f.velocity_covariance = 1e4 * Eigen::Matrix3d::Identity();
    all.push_back(f);
  }
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(119.0));
  ASSERT_TRUE(nav);
  const Eigen::Vector3d truth = drive.pose(119.0).translation() + (119.0 - departs) * ferry;
  EXPECT_LT((nav->position_enu - truth).head<2>().norm(), 5.0);
}

// A vehicle that leaves its parking place backwards, at 2.5 m/s, and then drives forward.
MotionProfile reversed_out() {
  MotionProfile profile;
  profile.speed = [](double t) { return -2.5 + 6.25 * (1.0 + std::tanh((t - 12.0) / 2.0)); };
  profile.yaw_rate = [](double t) { return 0.1 * std::sin(t / 9.0); };
  profile.azimuth = 1.0;
  return profile;
}

TEST(StartInReverse, TurnsRoundAsSoonAsTheVehicleRacesBackwards) {
  const SyntheticDrive drive(reversed_out(), 40.0, test_origin());
  for (const bool wheels : {false, true}) {
    SCOPED_TRACE(wheels);
    ReducedImuFilter filter(configured(wheels ? "GNSS+RISS" : "GNSS+RI"), test_origin());
    std::vector<Measurement> all;
    append(all, drive.imu(100.0));
    if (wheels) append(all, drive.wheels(0.0, 40.0));
    for (double t = 0.0; t <= 40.0; t += 0.5) all.push_back(fix(drive, t));
    add_as_available(filter, all);
    const auto nav = filter.state_at(SyntheticDrive::at(39.0));
    ASSERT_TRUE(nav);
    EXPECT_LT(std::abs(wrap_angle(nav->attitude.azimuth - drive.azimuth(39.0))), radians(3.0));
    EXPECT_NEAR(nav->forward_speed, drive.speed(39.0), 0.3);
    EXPECT_LT(horizontal_error(*nav, drive, 39.0), 1.5);
  }
}

// A receiver that repeats its last fix with new stamps while the vehicle drives on, stops or turns.
TEST(RepeatedFix, JudgesNeitherWheelsNorStandstillNorHeading) {
  MotionProfile profile;
  profile.speed = [](double t) { return 6.0 * (1.0 - std::tanh((t - 50.0) / 3.0)); };
  profile.yaw_rate = [](double t) { return t > 30.0 && t < 40.0 ? 0.1 * std::numbers::pi : 0.0; };
  const SyntheticDrive drive(profile, 80.0, test_origin());
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 80.0));
  for (double t = 0.0; t <= 80.0; t += 0.5) {
    GnssFix f = fix(drive, std::min(t, 25.0));
    f.stamp = f.velocity_stamp = SyntheticDrive::at(t);
    f.available = f.stamp + from_seconds(0.1);
    f.sequence = static_cast<std::uint64_t>(2.0 * t);
    all.push_back(f);
  }
  add_as_available(filter, all);
  EXPECT_EQ(filter.status().refused_for(Reason::wheels_wrong), 0U);
  const auto nav = filter.state_at(SyntheticDrive::at(79.0));
  ASSERT_TRUE(nav);
  EXPECT_LT(std::abs(wrap_angle(nav->attitude.azimuth - drive.azimuth(79.0))), radians(10.0));
  EXPECT_NEAR(nav->forward_speed, 0.0, 0.3);
}

// Wheels that tell the sign of the speed, while odometry carries the vehicle's own frame on.
TEST(StartInReverse, TurningRoundDoesNotMoveTheFrameOfOdometry) {
  FilterState state;
  state.stamp = state.clone_stamp = SyntheticDrive::at(10.0);
  state.wheel_stamp = state.stamp;
  state.x[index::speed] = 10.0;
  state.x[index::azimuth] = 1.0;
  state.P.setIdentity();
  const FusionParameters p = configured("GNSS+RISS");
  const LocalFrame frame(test_origin());
  take_clone(state);
  const OdomPose before = state.odom();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int i = 0; i < 10; ++i) {
    GnssFix f = fix_of(10.0 + 0.5 * i, 0.0);
    f.velocity_enu = -10.0 * direction(1.0, 0.0);
    f.position = frame.to_geodetic(place);
    place += 0.5 * f.velocity_enu;
    state.wheel_stamp = f.velocity_stamp;
    judge_by_velocity(state, f, frame, p);
  }
  EXPECT_NEAR(std::abs(wrap_angle(state.x[index::azimuth] - 1.0)), std::numbers::pi, 1e-9);
  EXPECT_EQ(state.x[index::speed], 10.0);
  EXPECT_TRUE(state.odom().rotation.isApprox(before.rotation, 1e-9));
  EXPECT_TRUE(state.odom().position.isApprox(before.position, 1e-9));

  // Once it has driven forward as fast as this, its front is known.
  FilterState known = state;
  known.front_known = true;
  for (int i = 10; i < 20; ++i) {
    GnssFix f = fix_of(10.0 + 0.5 * i, 0.0);
    f.velocity_enu = 10.0 * direction(1.0, 0.0);
    f.position = frame.to_geodetic(place);
    place += 0.5 * f.velocity_enu;
    known.wheel_stamp = f.velocity_stamp;
    judge_by_velocity(known, f, frame, p);
  }
  EXPECT_EQ(known.x[index::azimuth], state.x[index::azimuth]);
}

}  // namespace velocity_witness_test
}  // namespace maploop::fusion
