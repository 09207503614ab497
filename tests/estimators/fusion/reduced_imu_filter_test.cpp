// These tests cover the whole filter on drives of known truth.
#include "estimators/fusion/reduced_imu_filter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/least_eigenvalue.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

// The drive through a town has stops, corners, hills and a tilted road.
MotionProfile hilly_town() {
  MotionProfile profile;
  profile.speed = [](double t) { return 8.0 + 5.0 * std::sin(t / 7.0); };
  profile.yaw_rate = [](double t) { return 0.35 * std::pow(std::sin(t / 9.0), 5); };
  profile.pitch = [](double t) { return 0.04 * std::sin(t / 11.0); };
  profile.roll = [](double t) { return 0.03 * std::sin(t / 6.0); };
  profile.azimuth = 0.8;
  return profile;
}

SensorNoise usual_noise() {
  return {.gyro_bias = 1e-4,
          .gyro_density = 8.7e-5,
          .force_sigma = 0.2,
          .odometry_speed_sigma = 0.05,
          .odometry_rotation_sigma = radians(0.04),
          .seed = 7};
}

struct Errors {
  double position = 0.0, speed = 0.0, azimuth = 0.0, pitch = 0.0, roll = 0.0;  // largest
};

Errors largest_errors(const SyntheticDrive& drive, const std::vector<NavState>& states) {
  Errors e;
  for (const NavState& nav : states) {
    const double t = to_seconds(nav.stamp - SyntheticDrive::at(0.0));
    const auto update = [](double& largest, double v) { largest = std::max(largest, std::abs(v)); };
    update(e.position, (nav.position_enu - drive.pose(t).translation()).norm());
    update(e.speed, nav.forward_speed - drive.speed(t));
    update(e.azimuth, wrap_angle(nav.attitude.azimuth - drive.azimuth(t)));
    update(e.pitch, nav.attitude.pitch - drive.pitch(t));
    update(e.roll, nav.attitude.roll - drive.roll(t));
  }
  return e;
}

std::vector<NavState> run(const SyntheticDrive& drive, double imu_rate, const SensorNoise& noise,
                          ReducedImuFilter& filter) {
  return states_after_odometry(filter, as_available(drive.imu(imu_rate, noise),
                                                    drive.odometry(10.0, noise), drive.fix(0.0)));
}

TEST(Truth, StraightLineIsKept) {
  const SyntheticDrive drive({}, 60.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 100.0, {}, filter);
  ASSERT_EQ(states.size(), 600u);
  const Errors e = largest_errors(drive, states);
  EXPECT_LT(e.position, 0.05) << "over 600 m";  // 28 mm come from the Earth's curvature
  EXPECT_LT(e.speed, 0.01);
  EXPECT_LT(degrees(e.azimuth), 0.002);
}

TEST(Truth, ConstantTurnIsKeptAtEveryRateOfTheImu) {
  MotionProfile circle;
  circle.yaw_rate = [](double) { return 0.25; };
  const SyntheticDrive drive(circle, 60.0, test_origin());
  FusionParameters parameters;
  parameters.rear_slip = 0.0;  // of this vehicle
  for (const double rate : {10.0, 50.0, 100.0}) {
    ReducedImuFilter filter(parameters, test_origin());
    const Errors e = largest_errors(drive, run(drive, rate, {}, filter));
    EXPECT_LT(e.position, 0.05) << rate;
    EXPECT_LT(degrees(e.azimuth), 0.01) << rate;
  }
}

TEST(Truth, TownIsKeptWithPerfectSensors) {
  const SyntheticDrive drive(hilly_town(), 120.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 100.0, {}, filter);
  const Errors e = largest_errors(drive, states);
  EXPECT_LT(e.position, 0.6) << "over 960 m";
  EXPECT_LT(degrees(e.azimuth), 0.1);  // pitch rate times roll, which one gyro cannot measure
  EXPECT_EQ(states.back().odometry_refused, 0u);
}

TEST(Truth, TownIsKeptWithUsualSensors) {
  const SyntheticDrive drive(hilly_town(), 120.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 100.0, usual_noise(), filter);
  const Errors e = largest_errors(drive, states);
  EXPECT_LT(e.position, 5.0) << "over 960 m";
  EXPECT_LT(e.speed, 0.3);
  EXPECT_LT(degrees(e.azimuth), 0.8);
  EXPECT_LT(degrees(e.pitch), 2.0);
  EXPECT_LT(degrees(e.roll), 2.0);
  EXPECT_LE(states.back().odometry_refused, 4u);  // 0.2 % of 1200 and a margin
}

TEST(Truth, AccelerometersBringPitchAndRollBackWithoutHelp) {
  // A start from a fix knows neither: it takes the pitch from the climb, and zero for the roll.
  MotionProfile tilted;
  tilted.pitch = [](double) { return 0.0; };
  tilted.roll = [](double) { return 0.06; };
  const SyntheticDrive drive(tilted, 90.0, test_origin());
  GnssFix fix = drive.fix(0.0);
  fix.velocity_enu.z() = 0.5;  // 2.9 deg of wrong climb
  fix.velocity_covariance(2, 2) = 0.25;
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states =
      states_after_odometry(filter, as_available(drive.imu(100.0), drive.odometry(10.0), fix));
  EXPECT_GT(degrees(states.front().attitude.pitch), 1.0);
  EXPECT_NEAR(degrees(states.back().attitude.pitch), 0.0, 0.3);
  EXPECT_NEAR(degrees(states.back().attitude.roll), degrees(0.06), 0.6);
}

TEST(Truth, StandstillKeepsThePosition) {
  MotionProfile stop;
  stop.speed = [](double t) {
    return t < 10.0 ? 4.0 * (1.0 + std::cos(t * std::numbers::pi / 10.0)) : 0.0;
  };
  const SyntheticDrive drive(stop, 130.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  SensorNoise noise = usual_noise();
  noise.odometry_speed_sigma = 0.02;  // features do not move
  const std::vector<NavState> states = run(drive, 100.0, noise, filter);
  const NavState& stopped = states[150];
  const NavState& last = states.back();
  EXPECT_LT((last.position_enu - stopped.position_enu).norm(), 0.3) << "in two minutes";
  EXPECT_NEAR(last.forward_speed, 0.0, 0.05);
  EXPECT_EQ(last.status, NavStatus::aided);
}

TEST(Truth, GyroBiasIsObservedByTheAzimuthOfOdometry) {
  const SyntheticDrive drive(hilly_town(), 600.0, test_origin());
  SensorNoise noise = usual_noise();
  noise.gyro_bias = 5e-4;  // 103 deg/h, three sigma
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 20.0, noise, filter);
  EXPECT_NEAR(states.back().gyro_bias, 5e-4, 1.2e-4);
}

TEST(Truth, ReversingIsKept) {
  MotionProfile profile;
  profile.speed = [](double t) { return 6.0 * std::cos(t / 6.0); };
  profile.yaw_rate = [](double t) { return 0.1 * std::sin(t / 3.0); };
  const SyntheticDrive drive(profile, 40.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const Errors e = largest_errors(drive, run(drive, 100.0, usual_noise(), filter));
  EXPECT_LT(e.position, 1.5);
  EXPECT_LT(e.speed, 0.3);
}

TEST(Covariance, StaysSymmetricAndPositiveOverHalfAnHour) {
  const SyntheticDrive drive(hilly_town(), 1800.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 10.0, usual_noise(), filter);
  ASSERT_EQ(states.size(), 18'000u);
  for (std::size_t i = 0; i < states.size(); i += 100) {
    const Eigen::Matrix<double, 9, 9>& P = states[i].covariance;
    ASSERT_EQ(P, P.transpose()) << i;
    const Eigen::Matrix<double, 9, 1> sigma = P.diagonal().cwiseSqrt();
    const Eigen::Matrix<double, 9, 9> correlation =
        sigma.cwiseInverse().asDiagonal() * P * sigma.cwiseInverse().asDiagonal();
    ASSERT_GT(least_eigenvalue(correlation), 1e-9) << i;
  }
}

// Returns the squared error of position and azimuth normalized by their covariance; its mean is 3
// if the covariance is right.
double normalized_error(const NavState& nav, const SyntheticDrive& drive, double t) {
  Eigen::Vector3d error;
  error << (nav.position_enu - drive.pose(t).translation()).head<2>(),
      wrap_angle(nav.attitude.azimuth - drive.azimuth(t));
  Eigen::Matrix3d C;
  const int picked[] = {0, 1, 6};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) C(i, j) = nav.covariance(picked[i], picked[j]);
  }
  return error.dot(C.inverse() * error);
}

// Compares the errors of position and azimuth after 20 s with their covariance over many seeds;
// each seed draws start, sensors and the odometry's scale.
TEST(Covariance, IsHonest) {
  const SyntheticDrive drive(hilly_town(), 20.0, test_origin());
  double nees = 0.0;
  constexpr unsigned runs = 60;
  for (unsigned seed = 0; seed < runs; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const FusionParameters p;
    SensorNoise noise = usual_noise();
    noise.seed = 100 + seed;
    noise.gyro_bias = p.gyro_turn_on_sigma * normal(random);
    GnssFix fix = drive.fix(0.0);
    for (int i = 0; i < 3; ++i) fix.velocity_enu[i] += 0.1 * normal(random);
    Eigen::Vector3d shift;
    for (double& v : shift) v = normal(random);
    const LocalFrame frame(test_origin());
    fix.position = frame.to_geodetic(frame.to_enu(fix.position) + shift);
    std::vector<RelativeMotion> odometry = drive.odometry(10.0, noise);
    const double scale = 1.0 + p.speed_scale_sigma * normal(random);
    for (RelativeMotion& m : odometry) m.translation *= scale;
    ReducedImuFilter filter(p, test_origin());
    const NavState last =
        states_after_odometry(filter, as_available(drive.imu(100.0, noise), odometry, fix)).back();

    nees += normalized_error(last, drive, 20.0) / runs;
  }
  // The mean is 3 if all is as modelled. The model also expects side slip and a course that differs
  // from the azimuth, which this drive does not have, so 2.1 is reached.
  EXPECT_LT(nees, 3.0);
  EXPECT_GT(nees, 1.0);
}

// A LiDAR's noise is small, and after a minute its lasting errors dominate. A filter without a
// model of them is far too confident.
TEST(Covariance, IsHonestOfALidarThatErrsAllTheTime) {
  const SyntheticDrive drive({}, 60.0, test_origin());
  FusionParameters usual;
  usual.slip_sigma = 1e-4;  // the drive has no side slip
  const auto mean_error = [&](const FusionParameters& p) {
    double nees = 0.0;
    constexpr unsigned runs = 20;
    for (unsigned seed = 0; seed < runs; ++seed) {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      SensorNoise noise = usual_noise();
      noise.seed = 200 + seed;
      noise.gyro_bias = p.gyro_turn_on_sigma * normal(random);
      noise.odometry_speed_sigma = 0.02;
      noise.odometry_rotation_sigma = radians(0.01);
      std::vector<RelativeMotion> odometry = drive.odometry(10.0, noise);
      const double scale = 1.0 + usual.lidar_scale_sigma * normal(random);
      const double turn = usual.lidar_turn_sigma * normal(random);
      for (RelativeMotion& m : odometry) {
        m.source = OdometrySource::lidar;
        m.rotation =
            Eigen::AngleAxisd(turn * m.translation.x(), Eigen::Vector3d::UnitZ()) * m.rotation;
        m.translation *= scale;
      }
      KnownStart start;
      start.stamp = SyntheticDrive::at(0.0);
      start.position = test_origin();
      start.attitude = {drive.azimuth(0.0) + start.azimuth_sigma * normal(random), drive.pitch(0.0),
                        drive.roll(0.0)};
      start.speed = drive.speed(0.0);
      ReducedImuFilter filter(p, test_origin());
      filter.start(start);
      const auto all = as_available(drive.imu(100.0, noise), odometry, {});
      nees += normalized_error(states_after_odometry(filter, all).back(), drive, 60.0) / runs;
    }
    return nees;
  };
  const double honest = mean_error(usual);
  EXPECT_LT(honest, 4.0);  // 3 if all is as modelled
  EXPECT_GT(honest, 1.0);
  FusionParameters knows_nothing = usual;
  knows_nothing.lidar_scale_sigma = knows_nothing.lidar_turn_sigma = 0.0;
  const double blind = mean_error(knows_nothing);
  std::printf("normalized error: %.1f, of a filter that knows nothing of it %.1f\n", honest, blind);
  EXPECT_GT(blind, 2.0 * 3.0);
}

TEST(Output, IsWrappedAndContinuousThroughSouth) {
  MotionProfile profile;
  profile.azimuth = 3.0;
  profile.yaw_rate = [](double) { return -0.05; };
  const SyntheticDrive drive(profile, 20.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = run(drive, 100.0, {}, filter);
  bool wrapped = false;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const double step = states[i].attitude.azimuth - states[i - 1].attitude.azimuth;
    wrapped = wrapped || step < -3.0;
    EXPECT_NEAR(wrap_angle(step), 0.005, 1e-3);
    EXPECT_LE(std::abs(states[i].attitude.azimuth), std::numbers::pi);
  }
  EXPECT_TRUE(wrapped);
}

TEST(Output, CoastsWithoutOdometryAndSaysSo) {
  const SyntheticDrive drive(hilly_town(), 20.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  filter.add(drive.fix(0.0));
  const std::vector<RelativeMotion> odometry = drive.odometry(10.0);
  for (const ImuSample& s : drive.imu(100.0)) {
    filter.add(s);
    for (const RelativeMotion& m : odometry) {
      if (m.stamp == s.stamp && m.stamp <= SyntheticDrive::at(10.0)) filter.add(m);
    }
  }
  const auto state = [&](double t) { return *filter.state_at(SyntheticDrive::at(t)); };
  EXPECT_EQ(state(20.0).status, NavStatus::coasting);
  EXPECT_EQ(state(20.0).odometry_stamp, SyntheticDrive::at(10.0));
  EXPECT_EQ(state(20.0).imu_stamp, SyntheticDrive::at(20.0));
  EXPECT_LT((state(20.0).position_enu - drive.pose(20.0).translation()).norm(), 3.0);
  EXPECT_GT(state(20.0).covariance(0, 0), state(18.5).covariance(0, 0));
}

TEST(Output, IsPredictedBeyondTheNewestAndNothingBeforeTheHistory) {
  const SyntheticDrive drive({}, 10.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  run(drive, 100.0, {}, filter);
  const NavState ahead = *filter.state_at(SyntheticDrive::at(10.05));
  EXPECT_EQ(ahead.stamp, SyntheticDrive::at(10.05));
  EXPECT_EQ(ahead.imu_stamp, SyntheticDrive::at(10.0));
  EXPECT_NEAR(ahead.position_enu.y(), 100.5, 0.05);
  EXPECT_TRUE(filter.state_at(SyntheticDrive::at(8.1)));
  EXPECT_FALSE(filter.state_at(SyntheticDrive::at(5.0)));
  EXPECT_FALSE(filter.state_at(SyntheticDrive::at(16.0))) << "beyond max_gap";
  EXPECT_FALSE(filter.state_at(Time::max()));
  EXPECT_FALSE(filter.state_at(Time::min()));
}

TEST(Output, AskingChangesNothing) {
  const SyntheticDrive drive(hilly_town(), 10.0, test_origin());
  ReducedImuFilter asked({}, test_origin()), left_alone({}, test_origin());
  for (const Measurement& m :
       as_available(drive.imu(100.0), drive.odometry(10.0), drive.fix(0.0))) {
    add(asked, m);
    add(left_alone, m);
    asked.state_at(stamp_of(m) - from_seconds(0.123));
    asked.state_at(stamp_of(m) + from_seconds(0.037));
  }
  const Time t = SyntheticDrive::at(10.0);
  EXPECT_EQ(asked.state_at(t)->position_enu, left_alone.state_at(t)->position_enu);
  EXPECT_EQ(asked.state_at(t)->covariance, left_alone.state_at(t)->covariance);
}

TEST(SilentImu, OdometryCarriesTheFilterAlone) {
  const SyntheticDrive drive(hilly_town(), 60.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states = states_after_odometry(
      filter, as_available({}, drive.odometry(10.0, usual_noise()), drive.fix(0.0)));
  ASSERT_EQ(states.size(), 600u);
  const Errors e = largest_errors(drive, states);
  EXPECT_LT(e.position, 10.0);
  EXPECT_LT(degrees(e.azimuth), 2.5);
  EXPECT_LE(states.back().odometry_refused, 3u);
}

TEST(LostOdometry, TheNextIntervalStartsAnewWhereverItBegins) {
  const SyntheticDrive drive(hilly_town(), 30.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  filter.add(drive.fix(0.0));
  for (const ImuSample& s : drive.imu(100.0)) filter.add(s);
  // The motions arrive late by up to 2 s all at once; every third message is lost.
  int applied = 0;
  for (const RelativeMotion& m : drive.odometry(10.0)) {
    if (m.stamp <= SyntheticDrive::at(28.3) || m.sequence % 3 == 0) continue;
    applied += filter.add(m).refused() ? 0 : 1;
  }
  EXPECT_EQ(applied, 11);
  EXPECT_EQ(filter.state_at(SyntheticDrive::at(30.0))->odometry_refused, 0u);
}

TEST(Recovery, AWrongSpeedIsCorrectedAfterARowOfRefusals) {
  const SyntheticDrive drive({}, 20.0, test_origin());
  GnssFix fix = drive.fix(0.0);
  fix.velocity_enu *= 0.5;  // 5 m/s too slow, with a small sigma
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states =
      states_after_odometry(filter, as_available(drive.imu(100.0), drive.odometry(10.0), fix));
  EXPECT_EQ(filter.status().recoveries, 1u);
  EXPECT_EQ(states.back().odometry_refused, 9u);
  EXPECT_GE(filter.status().refused_for(Reason::speed_gate), 9u);
  EXPECT_NEAR(states.back().forward_speed, 10.0, 0.1);
}

TEST(Origin, IsTheFirstFixWhenNoneIsGiven) {
  const SyntheticDrive drive({}, 1.0, test_origin());
  ReducedImuFilter filter({});
  const GnssFix fix = drive.fix(0.0);
  EXPECT_EQ(filter.add(fix), Outcome{});
  EXPECT_EQ(filter.frame().origin().latitude, fix.position.latitude);
  EXPECT_LT(filter.state_at(fix.stamp)->position_enu.norm(), 1e-6);
}

}  // namespace
}  // namespace maploop::fusion
