// Compiles and tests what README.md describes: the driver in the vehicle's graph, and the estimator
// alone.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "tests/examples/speed_estimator.h"
#include "tests/examples/wheel_log.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::example {
namespace {

using std::chrono::milliseconds;

class WheelLogTest : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) const {
    const auto file = folder_.path() / "wheels.csv";
    std::ofstream(file) << text;
    return file;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(WheelLogTest, StampsAreOlderThanTheirDelivery) {
  WheelLog log(written("100.5,7.25\n"), milliseconds(20), 0.1);
  WheelSpeed sample;
  ASSERT_TRUE(log.next(sample));
  EXPECT_EQ(sample.available, from_nanoseconds(100'500'000'000));
  EXPECT_EQ(sample.available - sample.stamp, milliseconds(20));
  EXPECT_EQ(sample.speed, 7.25);
  EXPECT_EQ(sample.sigma, 0.1);
  EXPECT_FALSE(log.next(sample));
}

TEST_F(WheelLogTest, WhatIsNoSampleIsLeftOutAndReported) {
  WheelLog log(written("1,1\nrubbish\n2,nan\n1,5\n\n3,3\n4,inf\n5"), {}, 0.1);
  WheelSpeed sample;
  ASSERT_TRUE(log.next(sample));
  ASSERT_TRUE(log.next(sample));
  EXPECT_EQ(sample.speed, 3.0);
  EXPECT_EQ(sample.sequence, 5u) << "the gap shows what is missing";
  EXPECT_FALSE(log.next(sample));
  EXPECT_EQ(log.report().delivered, 2u);
  EXPECT_EQ(log.report().refused, 6u);
  EXPECT_EQ(log.report().refusals.front().line, 2u);
  EXPECT_THROW(WheelLog("nowhere.csv", {}, 0.1), std::runtime_error);
}

TEST_F(WheelLogTest, TheVehicleDrivesByIt) {
  using vehicle::testing::drive_start;
  std::string rows;
  for (int i = 0; i < 40; ++i) {
    rows += std::to_string(to_nanoseconds(drive_start) / 1'000'000'000) + '.' +
            std::string(i < 4 ? "0" : "") + std::to_string(25 * i) + ",10.0\n";
  }
  vehicle::Sensors sensors = vehicle::testing::fake_sensors(1.0);
  sensors.camera.reset();
  sensors.velodyne.reset();
  sensors.wheel = std::make_unique<WheelLog>(written(rows), milliseconds(20), 0.1);
  vehicle::VehicleConfig config;
  set_configuration(config, "RISS");
  NavState last;
  vehicle::Observer observer;
  observer.nav_state = [&last](const NavState& state) { last = state; };
  vehicle::ChannelHashes hashes;
  vehicle::Vehicle vehicle(config, vehicle::testing::fake_calibration(), std::move(sensors),
                           runtime::DataClock::virtual_time(), {&hashes}, observer);
  vehicle.start();
  vehicle.wait();
  EXPECT_EQ(hashes.summary().at("WHEEL_SPEED").count, 40u);
  EXPECT_NEAR(last.position_enu.y(), 10.0 * to_seconds(last.stamp - drive_start), 0.5);
}

WheelSpeed speed_at(double seconds, double speed) {
  WheelSpeed sample;
  sample.stamp = sample.available = from_nanoseconds(0) + from_seconds(100.0 + seconds);
  sample.speed = speed;
  sample.sigma = 0.1;
  return sample;
}

TEST(SpeedEstimatorTest, FindsTheAccelerationAndStatesItsError) {
  SpeedEstimator estimator({});
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::optional<SpeedEstimate> estimate;
  for (int i = 0; i <= 100; ++i)
    estimate = estimator.add(speed_at(0.1 * i, 5.0 + 0.2 * i + noise(random)));
  ASSERT_TRUE(estimate);
  const double error = estimate->acceleration - 2.0;
  EXPECT_LT(std::abs(error), 3.0 * std::sqrt(estimate->covariance(1, 1)));
  EXPECT_LT(estimate->covariance(0, 0), 0.1 * 0.1) << "better than one sample";
}

TEST(SpeedEstimatorTest, AWrongSampleIsRefusedWithItsReason) {
  SpeedEstimator estimator({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(estimator.add(speed_at(0.0, nan)));
  for (int i = 0; i < 20; ++i) estimator.add(speed_at(0.1 * i, 10.0));
  EXPECT_EQ(estimator.add(speed_at(2.0, 30.0))->reason, SpeedReason::gate);
  EXPECT_EQ(estimator.add(speed_at(1.0, 10.0))->reason, SpeedReason::not_later);
  EXPECT_EQ(estimator.add(speed_at(2.1, nan))->reason, SpeedReason::not_finite);
  EXPECT_NEAR(estimator.add(speed_at(2.1, 10.0))->speed, 10.0, 0.1);
  EXPECT_EQ(estimator.add(speed_at(60.0, 3.0))->speed, 3.0) << "it begins anew after a gap";
  SpeedParameters wrong;
  wrong.jerk = 0.0;
  EXPECT_THROW(SpeedEstimator{wrong}, std::invalid_argument);
}

TEST(SpeedEstimatorTest, GoesOnWithTheSameBitsFromAnArchive) {
  SpeedEstimator one({}), other({});
  for (int i = 0; i < 20; ++i) one.add(speed_at(0.1 * i, 10.0 + 0.03 * i));
  testing::load(testing::saved(one), other);
  EXPECT_EQ(one.add(speed_at(2.0, 10.7))->speed, other.add(speed_at(2.0, 10.7))->speed);
  testing::expect_refuses_broken(testing::saved(one), other);
}

}  // namespace
}  // namespace maploop::example
