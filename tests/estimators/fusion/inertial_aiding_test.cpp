// These tests cover what the filter learns from inertial samples: a standstill, the grade by six
// axes, and how late the samples are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/estimators/fusion/town_drive.h"

namespace maploop::fusion {
namespace inertial_aiding_test {

using namespace maploop::testing;
using namespace maploop::testing::town_drive;

TEST(StandingStill, ShowsTheGyrosBiasAndIsNotSeenOnASmoothRoad) {
  MotionProfile stop;
  stop.speed = [](double t) { return t < 8.0 ? 8.0 - t : 0.0; };
  const SyntheticDrive drive(stop, 30.0, test_origin());
  const double bias = 1.2e-3;
  const auto run = [&](bool used) {
    FusionParameters p = configured("RISS");
    apply_grade("mems", p);
    p.use_zero_velocity = used;
    ReducedImuFilter filter(p, test_origin());
    std::vector<Measurement> all{fix(drive, 0.0)};
    append(all, drive.imu(100.0, {.gyro_bias = bias}));
    append(all, drive.wheels(0.0, 30.0));
    add_as_available(filter, all);
    return *filter.state_at(SyntheticDrive::at(29.5));
  };
  const NavState with = run(true), without = run(false);
  EXPECT_GT(with.zero_velocity_stamp, SyntheticDrive::at(29.0));
  EXPECT_NEAR(with.gyro_bias, bias, 1e-4);
  EXPECT_EQ(without.zero_velocity_stamp, Time{});
  EXPECT_GT(std::abs(without.gyro_bias - bias), 5e-4);

  const SyntheticDrive smooth({}, 20.0, test_origin());
  ReducedImuFilter filter(configured("RISS"), test_origin());
  std::vector<Measurement> all{fix(smooth, 0.0)};
  append(all, smooth.imu(100.0));
  append(all, smooth.wheels(0.0, 20.0));
  add_as_available(filter, all);
  EXPECT_EQ(filter.state_at(SyntheticDrive::at(19.5))->zero_velocity_stamp, Time{});
}

// Hills look like acceleration to the forward force alone.
TEST(SixAxes, TellTheForwardForceFromTheGrade) {
  MotionProfile hills = town();
  hills.pitch = [](double t) { return 0.05 * std::sin(0.11 * t); };
  hills.roll = [](double t) { return 0.03 * std::sin(0.07 * t); };
  constexpr double end = 149.0;
  const SyntheticDrive drive(hills, end + 1.0, test_origin());
  std::mt19937 random(5);
  std::vector<Measurement> all;
  append(all, drive.imu(100.0, {.gyro_bias = 5e-4,
                                .tilt_gyro_bias = 4e-4,
                                .gyro_density = 8.7e-5,
                                .force_sigma = 0.2}));
  for (int i = 0; i <= 90; ++i) all.push_back(fix(drive, i, &random));
  const auto run = [&](InertialAxes axes) {
    FusionParameters p = configured("GNSS+RI");
    apply_grade("mems", p);
    p.inertial_axes = axes;
    ReducedImuFilter filter(p, test_origin());
    add_as_available(filter, all);
    return *filter.state_at(SyntheticDrive::at(end));
  };
  const NavState three = run(InertialAxes::three), six = run(InertialAxes::automatic);
  EXPECT_GT(horizontal_error(three, drive, end), 3.0 * horizontal_error(six, drive, end));
  EXPECT_LT(horizontal_error(six, drive, end), 15.0);
  EXPECT_NEAR(six.attitude.pitch, drive.pitch(end), radians(0.3));
  EXPECT_NEAR(six.attitude.roll, drive.roll(end), radians(0.5));
  EXPECT_GT(std::abs(three.attitude.pitch - drive.pitch(end)), radians(0.5));
}

// The speed before the stop is wrong by what a wrong accelerometer adds up to.
TEST(StandingStill, IsSeenByInertialSamplesAloneUnlessTheyAreShaken) {
  MotionProfile stop;
  stop.speed = [](double t) { return t < 8.0 ? 8.0 - t : 0.0; };
  const SyntheticDrive drive(stop, 30.0, test_origin());
  const auto run = [&](const char* configuration, double shaking) {
    ReducedImuFilter filter(configured(configuration), test_origin());
    std::vector<Measurement> all{fix(drive, 0.0)};
    auto samples = drive.imu(100.0, {.force_sigma = shaking});
    for (ImuSample& sample : samples) sample.specific_force_forward += 0.1;
    append(all, samples);
    add_as_available(filter, all);
    return *filter.state_at(SyntheticDrive::at(29.5));
  };
  const NavState quiet = run("GNSS+RI", 0.01);
  EXPECT_GT(quiet.zero_velocity_stamp, SyntheticDrive::at(29.0));
  EXPECT_NEAR(quiet.forward_speed, 0.0, 0.05);
  EXPECT_EQ(run("GNSS+RI", 0.2).zero_velocity_stamp, Time{});
  EXPECT_EQ(run("GNSS+VO-RI", 0.01).zero_velocity_stamp, Time{});
  // A smooth road is as quiet, but the speed is known there.
  const SyntheticDrive smooth({}, 20.0, test_origin());
  ReducedImuFilter filter(configured("GNSS+RI"), test_origin());
  std::vector<Measurement> all{fix(smooth, 0.0)};
  append(all, smooth.imu(100.0));
  for (double t = 0.5; t < 10.0; t += 0.5) all.push_back(fix(smooth, t));
  add_as_available(filter, all);
  const auto moving = filter.state_at(SyntheticDrive::at(19.5));
  ASSERT_TRUE(moving.has_value());
  EXPECT_EQ(moving->zero_velocity_stamp, Time{});
}

// The drive has two bends: the first shows the delay, and the states are compared in the second.
TEST(ImuDelay, LeftInTheStampsIsFoundAgainstOdometryAndAllowedFor) {
  const SyntheticDrive drive(town(), 43.0, test_origin());
  double azimuth_without = 0.0;
  for (const double left : {0.0, 0.03, -0.02}) {
    FusionParameters parameters = configured("VO-RI");
    parameters.imu_delay_sigma = 0.03;
    ReducedImuFilter filter(parameters, test_origin());
    std::vector<ImuSample> imu = drive.imu(100.0);
    for (ImuSample& s : imu) {
      s.stamp += from_seconds(left);
      s.available = s.stamp + from_seconds(0.06);
    }
    std::vector<Measurement> all{fix(drive, 0.0)};
    append(all, imu);
    append(all, drive.odometry(10.0));
    add_as_available(filter, all);
    const SelfCalibrations found = filter.calibration();
    const auto delay = std::ranges::find(found, "imu_delay", &CalibratedProperty::key);
    ASSERT_NE(delay, found.end());
    EXPECT_TRUE(delay->observed());
    EXPECT_NEAR(delay->value, 1e3 * left, 6.0) << left;
    const auto state = filter.state_at(SyntheticDrive::at(42.03));
    ASSERT_TRUE(state);
    if (left == 0.0) azimuth_without = state->attitude.azimuth;
    EXPECT_NEAR(wrap_angle(state->attitude.azimuth - azimuth_without), 0.0, radians(0.1)) << left;
  }
}

// The fixes are stamped late; the last second of the drive is scored.
TEST(GnssDelay, OfTheFixesIsFoundAndAllowedFor) {
  const SyntheticDrive drive(town(), 120.0, test_origin());
  for (const double late : {0.0, 0.1, 0.3}) {
    SCOPED_TRACE(late);
    std::vector<Measurement> all;
    append(all, drive.imu(100.0));
    append(all, drive.wheels(0.0, 120.0));
    for (double t = 0.0; t < 119.0; t += 1.0) {
      GnssFix f = fix(drive, t);
      for (Time* stamp : {&f.stamp, &f.velocity_stamp, &f.available}) *stamp += from_seconds(late);
      all.push_back(f);
    }
    const auto largest_error = [&](double sigma) {
      FusionParameters parameters = configured("GNSS+RISS");
      parameters.gnss_delay_sigma = sigma;
      ReducedImuFilter filter(parameters, test_origin());
      double largest = 0.0;
      add_as_available(filter, all);
      for (double t = 119.1; t < 119.95; t += 0.2) {
        const auto nav = filter.state_at(SyntheticDrive::at(t));
        EXPECT_TRUE(nav);
        if (nav) largest = std::max(largest, horizontal_error(*nav, drive, t));
      }
      const SelfCalibrations found = filter.calibration();
      const auto delay = std::ranges::find(found, "gnss_delay", &CalibratedProperty::key);
      EXPECT_NEAR(delay->value, sigma > 0.0 ? 1e3 * late : 0.0, 10.0 + 200.0 * late);
      EXPECT_EQ(delay->observed(), sigma > 0.0);
      return largest;
    };
    const double allowed_for = largest_error(FusionParameters{}.gnss_delay_sigma);
    EXPECT_LT(allowed_for, 1.0);
    if (late > 0.2) {
      EXPECT_GT(largest_error(0.0), 2.0 * allowed_for);
    }
  }
}

}  // namespace inertial_aiding_test
}  // namespace maploop::fusion
