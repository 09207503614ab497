#include "runtime/vehicle/graph/vehicle.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <thread>

#include "tests/runtime/vehicle/driven.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using runtime::DataClock;
using ::testing::Contains;
using testing::fake_calibration;
using testing::fake_sensors;
using ::testing::HasSubstr;

using testing::drive;
using testing::Driven;
using testing::expect_rings_balance;

// Drives on virtual time.
Driven undisturbed(double seconds) {
  return drive({.sensors = fake_sensors(seconds)});
}

TEST(Vehicle, LockstepGivesTheSameBitsOnEachRun) {
  const Driven first = undisturbed(5.0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(undisturbed(5.0).hashes(), first.hashes());
  for (const char* channel :
       {"NAV_STATE", "VO", "LIDAR_ODOMETRY", "ODOMETRY", "IMU", "GNSS_FIX", "TRUTH"}) {
    EXPECT_EQ(first.channels.at(channel).hash.size(), 16u) << channel;
  }
  EXPECT_EQ(first.channels.at("IMU").count, 500u);
  EXPECT_EQ(first.channels.at("VO").count, 50u) << "a result, or an explicit none, for each image";
  EXPECT_EQ(first.channels.at("GNSS_FIX").count, 5u);
  EXPECT_EQ(first.channels.at("HEALTH").hash, "") << "what speaks of the run is not hashed";
  const double ticks = static_cast<double>(first.channels.at("NAV_STATE").count);
  EXPECT_NEAR(ticks / first.report.data_seconds, 100.0, 0.5);
}

TEST(Vehicle, RealTimeAtAnySpeedAndATraceWrittenMeanwhileGiveTheBitsOfLockstep) {
  const Driven expected = undisturbed(3.0);
  for (const double speed : {4.0, 20.0, 1000.0}) {
    const Driven paced = drive({.sensors = fake_sensors(3.0), .speed = speed});
    EXPECT_EQ(paced.hashes(), expected.hashes()) << speed;
    expect_rings_balance(paced.report);
  }
  const maploop::testing::TemporaryFolder folder;
  runtime::Tracer tracer({});
  maploop::testing::MessageTape tape;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(3.0), DataClock::paced(10.0), {&tape}, {},
                  &tracer);
  vehicle.start();
  while (vehicle.running()) tracer.write(folder.path() / "trace.json");
  vehicle.wait();
  EXPECT_EQ(tape.all(), expected.messages);
  EXPECT_GT(tracer.recorded(), 1500u);
  EXPECT_EQ(tracer.dropped(), 0u);
}

TEST(Vehicle, NothingIsLostAndRingsBalance) {
  expect_rings_balance(undisturbed(20.0).report, true);
}

TEST(Vehicle, StopEndsInOrderAndPublishesWhatThereIs) {
  maploop::testing::MessageTape tape;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(3600.0), DataClock::paced(1.0), {&tape}, {});
  vehicle.start();
  while (vehicle.position() < vehicle.first() + std::chrono::milliseconds(300)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(vehicle.running());
  vehicle.stop();
  vehicle.wait();
  EXPECT_FALSE(vehicle.running());
  expect_rings_balance(vehicle.report());
  EXPECT_GE(tape.all().at("NAV_STATE").size(), 30u);
}

TEST(Vehicle, ADriverOrALoaderThatFailsIsNamedAndTheRestGoesOn) {
  Sensors sensors = fake_sensors(3.0);
  sensors.imu = testing::broken(std::move(sensors.imu), 100);
  const Driven no_imu = drive({.sensors = std::move(sensors)});
  EXPECT_EQ(no_imu.channels.at("IMU").count, 100u);
  EXPECT_EQ(no_imu.channels.at("VO").count, 30u);
  EXPECT_THAT(no_imu.report.health.degraded, Contains(HasSubstr("imu has ended: cable pulled")));
  sensors = fake_sensors(3.0);
  sensors.camera = testing::broken(std::move(sensors.camera), 7);
  const Driven no_images = drive({.sensors = std::move(sensors)});
  EXPECT_EQ(no_images.channels.at("VO").count, 7u);
  EXPECT_EQ(no_images.channels.at("IMU").count, 300u);
  EXPECT_THAT(no_images.report.health.degraded,
              Contains(HasSubstr("camera has ended: cable pulled")));
}

TEST(Vehicle, ADriverWhoseSamplesGoBackIsNamedAndItsLoaderEnds) {
  Sensors sensors = fake_sensors(3.0);
  Time last{};
  sensors.camera =
      sensors::derived(std::move(sensors.camera),
                       [last](sensors::Source<StereoPair>& all, StereoPair& pair) mutable {
                         if (!all.next(pair)) return false;
                         if (all.report().delivered == 8) pair.available = last;
                         last = pair.available;
                         return true;
                       });
  const Driven r = drive({.sensors = std::move(sensors)});
  EXPECT_EQ(r.channels.at("VO").count, 7u);
  EXPECT_EQ(r.channels.at("IMU").count, 300u);
  EXPECT_THAT(r.report.health.degraded,
              Contains(HasSubstr("broke its promise of increasing times at sample 7")));
}

TEST(Vehicle, AParameterThatCannotWorkIsAnErrorAndTheLoadersEnd) {
  VehicleConfig config;
  config.fusion.gyro_noise = -1.0;
  EXPECT_THROW(Vehicle(config, fake_calibration(), fake_sensors(2.0),
                       runtime::DataClock::virtual_time(), {}, {}),
               std::invalid_argument);
}

TEST(Vehicle, SensorsThatTheDriveLacksAreNoError) {
  Sensors sensors = fake_sensors(2.0);
  sensors.velodyne = nullptr;
  sensors.reference = nullptr;
  sensors.camera = nullptr;
  const Driven r = drive({.sensors = std::move(sensors)});
  EXPECT_EQ(r.channels.at("IMU").count, 200u);
  EXPECT_EQ(r.channels.count("VO"), 0u);
  EXPECT_EQ(r.channels.count("TRUTH"), 0u);
}

TEST(Vehicle, ADriveWithoutASingleSampleIsAnError) {
  Vehicle vehicle({}, fake_calibration(), Sensors{}, DataClock::virtual_time(), {}, {});
  EXPECT_THROW(vehicle.start(), std::runtime_error);
}

TEST(Vehicle, EveryThreadSaysHowItKeptItsTime) {
  const Driven r = drive({.sensors = fake_sensors(2.5), .speed = 4.0});
  const auto names = [](const std::vector<LatencySummary>& summaries) {
    std::string all;
    for (const LatencySummary& s : summaries) all += s.name + ' ';
    return all;
  };
  EXPECT_EQ(names(r.report.deadlines.threads), "stereo lidar fusion ");
  EXPECT_EQ(names(r.report.deadlines.wake_up),
            "camera velodyne imu gnss reference stereo lidar fusion health ");
  EXPECT_EQ(names(r.report.deadlines.execution),
            "camera velodyne imu gnss reference stereo lidar fusion publisher health ");
  EXPECT_EQ(names(r.report.deadlines.period_jitter), "fusion health ");
  double cpu = 0.0;
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_GT(thread.cpu, 0.0) << thread.name;
    EXPECT_EQ(thread.left_out, thread.name == "health" ? thread.left_out : 0u) << thread.name;
    cpu += thread.cpu;
  }
  EXPECT_EQ(r.report.health.threads.size(), 10u) << "five drivers, three stages, publisher, health";
  EXPECT_LE(cpu, r.report.health.cpu);
  EXPECT_GE(r.report.health.elapsed, 2.4 / 4.0);
}

TEST(Vehicle, MissedDeadlinesComeWithWhereTheTimeWent) {
  // Far too fast for the images: stereo must miss, and the data clock must wait for it.
  const Driven r = drive({.sensors = fake_sensors(5.0), .speed = 2000.0});
  EXPECT_GT(r.report.stalls, 0u);
  for (const auto* summaries : {&r.report.deadlines.threads, &r.report.deadlines.paths}) {
    for (const LatencySummary& s : *summaries) {
      EXPECT_EQ(s.worst.size(), std::min<std::uint64_t>(s.misses, 10)) << s.name;
      EXPECT_EQ(s.guilty.empty(), s.misses == 0) << s.name;
      Duration longest = s.max;
      for (const MissedDeadline& miss : s.worst) {
        EXPECT_GT(miss.latency, s.deadline) << s.name;
        EXPECT_LE(miss.latency, longest) << s.name << ": the longest first";
        longest = miss.latency;
        EXPECT_FALSE(miss.parts.empty()) << s.name;
      }
    }
  }
}

}  // namespace
}  // namespace maploop::vehicle
