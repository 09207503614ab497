// These tests cover GNSS, wheels and starts on drives of known truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/estimators/fusion/town_drive.h"

namespace maploop::fusion {
namespace aiding_test {

using namespace maploop::testing;
using namespace maploop::testing::town_drive;

TEST(Riss, LearnsTheWheelsScaleFromFixesAndKeepsItInAnOutage) {
  const SyntheticDrive drive(town(), 150.0, test_origin());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const FusionParameters p = configured("GNSS+RISS");
  ReducedImuFilter filter(p, test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0, {.gyro_bias = 5e-5, .gyro_density = 8.7e-5, .force_sigma = 0.2}));
  for (WheelSpeed w : drive.wheels(0.0, 150.0, 0.01)) {
    w.speed += 0.05 * normal(random);
    all.push_back(w);
  }
  for (int i = 0; i <= 90; ++i) all.push_back(fix(drive, i, &random));
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(149.0));
  ASSERT_TRUE(nav);
  EXPECT_LT(std::abs(nav->forward_speed / drive.speed(149.0) - 1.0), 0.006);
  double way = 0.0;
  for (double t = 90.0; t < 149.0; t += 0.1) way += 0.1 * drive.speed(t);
  EXPECT_LT(horizontal_error(*nav, drive, 149.0), 0.01 * way);
  EXPECT_EQ(filter.status().refused_for(Reason::wheel_gate), 0u);
}

TEST(Riss, IsBadlyOffWithoutTheFixesThatTeachTheScale) {
  const SyntheticDrive drive(town(), 60.0, test_origin());
  ReducedImuFilter filter(configured("RISS"), test_origin());
  std::vector<Measurement> all{fix(drive, 0.0)};
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 60.0, 0.05));
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(59.0));
  ASSERT_TRUE(nav);
  // The first fix and its speed explain a part of the 5 %.
  EXPECT_GT(nav->forward_speed / drive.speed(59.0), 1.01);
}

TEST(LateData, FixesAndWheelsGiveTheSameBitsInAnyOrder) {
  const SyntheticDrive drive(town(), 12.0, test_origin());
  std::vector<Measurement> all{fix(drive, 0.0)};
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  append(all, drive.wheels(0.113, 11.5, 0.01));
  std::mt19937 noise(5);
  for (int i = 1; i < 11; ++i) all.push_back(fix(drive, i, &noise));
  FusionParameters p = configured("GNSS+RISS-VO");
  ReducedImuFilter timely(p, test_origin());
  add_as_available(timely, all);

  std::mt19937 random(11);
  std::uniform_real_distribution<double> late(0.0, 1.0);
  for (Measurement& m : all) {
    std::visit(
        [&](auto& v) {
          if (v.stamp > SyntheticDrive::at(0.0)) v.available += from_seconds(late(random));
        },
        m);
  }
  ReducedImuFilter belated(p, test_origin());
  add_as_available(belated, all);
  for (const double t : {11.0, 11.5, 12.0}) {
    const auto a = timely.state_at(SyntheticDrive::at(t));
    const auto b = belated.state_at(SyntheticDrive::at(t));
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->position_enu, b->position_enu) << t;
    EXPECT_EQ(a->covariance, b->covariance) << t;
    EXPECT_EQ(a->gnss_stamp, b->gnss_stamp) << t;
    EXPECT_EQ(a->wheel_stamp, b->wheel_stamp) << t;
  }
}

TEST(Gnss, DoubtsItselfAndThenBeginsAnewWhereFixesGoOnToContradict) {
  const SyntheticDrive drive(town(), 60.0, test_origin());
  FusionParameters p = configured("GNSS+VO-RI");
  p.gnss_recovery_sigma = 5.0;  // so that inflating the covariance is not enough
  ReducedImuFilter filter(p, test_origin());
  const LocalFrame frame(test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  for (int i = 0; i <= 58; ++i) {
    GnssFix f = fix(drive, i);
    if (i > 20) {
      f.position = frame.to_geodetic(frame.to_enu(f.position) + Eigen::Vector3d(800.0, 0.0, 0.0));
    }
    all.push_back(f);
  }
  add_as_available(filter, all);
  const FilterStatus status = filter.status();
  EXPECT_EQ(status.reinitializations, 1u);
  EXPECT_GE(status.recoveries, 1u);
  EXPECT_GE(status.refused_for(Reason::position_gate), 8u);
  const auto nav = filter.state_at(SyntheticDrive::at(58.0));
  ASSERT_TRUE(nav);
  EXPECT_EQ(nav->reinitializations, 1u);
  EXPECT_NEAR(nav->position_enu.x() - drive.pose(58.0).translation().x(), 800.0, 5.0);
}

TEST(Gnss, ABadFirstFixIsForgottenWithinTenSecondsOfGoodOnes) {
  const SyntheticDrive drive(town(), 12.0, test_origin());
  const LocalFrame frame(test_origin());
  for (const double off : {10.0, 40.0, 400.0}) {
    ReducedImuFilter filter(configured("auto"), test_origin());
    std::vector<Measurement> all;
    append(all, drive.imu(100.0));
    append(all, drive.odometry(10.0));
    for (int i = 0; i <= 11; ++i) {
      GnssFix f = fix(drive, i);
      if (i == 0) {
        f.position = frame.to_geodetic(frame.to_enu(f.position) + Eigen::Vector3d(off, -off, 0.0));
        f.velocity_enu = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * f.velocity_enu;
      }
      all.push_back(f);
    }
    add_as_available(filter, all);
    EXPECT_LT(horizontal_error(*filter.state_at(SyntheticDrive::at(11.5)), drive, 11.5), 3.0)
        << off;
  }
}

TEST(Gnss, AntennaOnALeverArmIsTakenBack) {
  MotionProfile circle;
  circle.yaw_rate = [](double) { return 0.3; };
  const SyntheticDrive drive(circle, 60.0, test_origin());
  const Eigen::Vector3d lever(1.5, -0.5, 0.8);
  const LocalFrame frame(test_origin());
  const auto error = [&](bool told) {
    FusionParameters p = configured("GNSS+VO-RI");
    if (told) {
      p.gnss_lever_forward = lever.x();
      p.gnss_lever_left = lever.y();
      p.gnss_lever_up = lever.z();
    }
    ReducedImuFilter filter(p, test_origin());
    std::vector<Measurement> all;
    append(all, drive.imu(100.0));
    append(all, drive.odometry(10.0));
    for (int i = 0; i <= 58; ++i) {
      GnssFix f = fix(drive, i);
      const Eigen::Isometry3d pose = drive.pose(i);
      const Eigen::Vector3d arm = pose.rotation() * lever;
      f.position = frame.to_geodetic(pose.translation() + arm);
      f.velocity_enu += Eigen::Vector3d(0.0, 0.0, 0.3).cross(arm);
      f.position_covariance = 1e-4 * Eigen::Matrix3d::Identity();
      f.velocity_covariance = 1e-4 * Eigen::Matrix3d::Identity();
      all.push_back(f);
    }
    add_as_available(filter, all);
    return horizontal_error(*filter.state_at(SyntheticDrive::at(58.0)), drive, 58.0);
  };
  EXPECT_LT(error(true), 0.1);
  EXPECT_GT(error(false), 0.3);
}

TEST(Start, InReverseIsSeenByOdometryAndTurnedRound) {
  MotionProfile profile;
  profile.speed = [](double) { return -5.0; };
  profile.yaw_rate = [](double t) { return 0.1 * std::sin(t / 2.0); };
  profile.azimuth = 0.3;
  const SyntheticDrive drive(profile, 10.0, test_origin());
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  std::vector<Measurement> all{fix(drive, 0.0)};
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(9.0));
  ASSERT_TRUE(nav);
  EXPECT_NEAR(wrap_angle(nav->attitude.azimuth - drive.azimuth(9.0)), 0.0, radians(5.0));
  EXPECT_NEAR(nav->forward_speed, -5.0, 0.3);
  EXPECT_LT(horizontal_error(*nav, drive, 9.0), 3.0);
}

TEST(Start, FromGivenValuesWorksAtRest) {
  MotionProfile profile;
  profile.speed = [](double t) { return t < 3.0 ? 0.0 : 1.5 * (t - 3.0); };
  profile.azimuth = -1.2;
  const SyntheticDrive drive(profile, 10.0, test_origin());
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  KnownStart known;
  known.stamp = SyntheticDrive::at(0.0);
  known.position = test_origin();
  known.attitude.azimuth = -1.2;
  ASSERT_FALSE(filter.start(known).refused());
  EXPECT_EQ(filter.start(known).reason, Reason::already_started);
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  add_as_available(filter, all);
  const auto nav = filter.state_at(SyntheticDrive::at(9.0));
  ASSERT_TRUE(nav);
  EXPECT_LT(horizontal_error(*nav, drive, 9.0), 0.7);
  KnownStart nonsense = known;
  nonsense.attitude.pitch = std::numeric_limits<double>::quiet_NaN();
  ReducedImuFilter other(configured("VO-RI"), test_origin());
  EXPECT_EQ(other.start(nonsense).reason, Reason::not_finite);
}

TEST(ChainedAzimuth, LeadsToNearlyTheSameWayWhereNothingIsRefused) {
  const SyntheticDrive drive(town(), 40.0, test_origin());
  const auto azimuth_error = [&](bool chained) {
    FusionParameters p = configured("VO-RI");
    p.chain_odometry_azimuth = chained;
    ReducedImuFilter filter(p, test_origin());
    std::vector<Measurement> all{fix(drive, 0.0)};
    append(all, drive.imu(100.0, {.gyro_bias = 1e-4}));
    append(all, drive.odometry(10.0, {.odometry_rotation_sigma = radians(0.04)}));
    add_as_available(filter, all);
    return std::abs(wrap_angle(filter.state_at(SyntheticDrive::at(39.0))->attitude.azimuth -
                               drive.azimuth(39.0)));
  };
  EXPECT_LT(azimuth_error(false), radians(1.0));
  EXPECT_LT(azimuth_error(true), radians(1.0));
}

TEST(Configurations, AreFoundByNameAndListedWhereThereIsNone) {
  for (const std::string& name : configuration_names()) EXPECT_EQ(configuration(name).name, name);
  const Configuration c = configuration("gps + vo-ri");
  EXPECT_EQ(c.name, "GNSS+VO-RI");
  EXPECT_TRUE(c.gnss && c.odometry_speed && c.odometry_azimuth && !c.wheel_speed && !c.lidar);
  EXPECT_TRUE(configuration("VO-L-RI").lidar);
  EXPECT_TRUE(configuration("gps").gnss);
  EXPECT_FALSE(configuration("GNSS").inertial);
  FusionParameters alone;
  apply(configuration("GNSS+RI"), alone);
  EXPECT_TRUE(alone.use_gnss && alone.still_by_inertia);
  EXPECT_FALSE(alone.use_odometry_speed || alone.use_odometry_azimuth || alone.use_wheel_speed);
  apply(configuration("RISS"), alone);
  EXPECT_FALSE(alone.still_by_inertia);
  EXPECT_EQ(alone.pitch_noise, FusionParameters{}.pitch_noise);
  try {
    configuration("VORI");
    FAIL() << "should not be found";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("RISS-VO"), std::string::npos) << e.what();
  }
  FusionParameters p;
  EXPECT_THROW(apply_grade("navigation", p), std::invalid_argument);
}

}  // namespace aiding_test
}  // namespace maploop::fusion
