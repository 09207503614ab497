#include "runtime/vehicle/graph/vehicle.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include "runtime/vehicle/output/channel_hashes.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using runtime::DataClock;
using testing::fake_calibration;
using testing::fake_sensors;

struct Replayed {
  VehicleReport report;
  std::map<std::string, ChannelSummary> channels;
};

Replayed replay(const DataClock& clock, Sensors sensors) {
  ChannelHashes hashes;
  Vehicle vehicle({}, fake_calibration(), std::move(sensors), clock, {&hashes}, {});
  vehicle.start();
  vehicle.wait();
  return {vehicle.report(), hashes.summary()};
}

void expect_same_data(const Replayed& a, const Replayed& b) {
  for (const char* channel :
       {"NAV_STATE", "VO", "LIDAR_ODOMETRY", "ODOMETRY", "IMU", "GNSS_FIX", "TRUTH"}) {
    const ChannelSummary& x = a.channels.at(channel);
    const ChannelSummary& y = b.channels.at(channel);
    EXPECT_EQ(x.count, y.count) << channel;
    EXPECT_EQ(x.hash, y.hash) << channel;
    EXPECT_EQ(x.hash.size(), 16u) << channel;
  }
}

void expect_rings_balance(const VehicleReport& report) {
  for (const RingHealth& ring : report.health.rings) {
    EXPECT_EQ(ring.pushed, ring.popped + ring.lost + ring.held) << ring.name;
  }
}

TEST(Vehicle, LockstepGivesTheSameBitsOnEachRun) {
  const Replayed first = replay(DataClock::virtual_time(), fake_sensors(5.0));
  for (int i = 0; i < 3; ++i) {
    expect_same_data(first, replay(DataClock::virtual_time(), fake_sensors(5.0)));
  }
  EXPECT_EQ(first.channels.at("IMU").count, 500u);
  EXPECT_EQ(first.channels.at("VO").count, 50u) << "a result, or an explicit none, for each image";
  EXPECT_EQ(first.channels.at("GNSS_FIX").count, 5u);
}

TEST(Vehicle, RealTimeAtAnySpeedGivesTheBitsOfLockstep) {
  const Replayed lockstep = replay(DataClock::virtual_time(), fake_sensors(3.0));
  for (const double speed : {2.0, 10.0, 1000.0}) {
    const Replayed paced = replay(DataClock::paced(speed), fake_sensors(3.0));
    expect_same_data(lockstep, paced);
    expect_rings_balance(paced.report);
    EXPECT_EQ(paced.channels.at("HEALTH").hash, "") << "what speaks of the run is not hashed";
  }
}

TEST(Vehicle, ATraceWrittenMeanwhileChangesNoBit) {
  const maploop::testing::TemporaryFolder folder;
  const Replayed untraced = replay(DataClock::virtual_time(), fake_sensors(3.0));
  runtime::Tracer tracer({});
  ChannelHashes hashes;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(3.0), DataClock::paced(10.0), {&hashes}, {},
                  &tracer);
  vehicle.start();
  while (vehicle.running()) tracer.write(folder.path() / "trace.json");
  vehicle.wait();
  expect_same_data(untraced, {vehicle.report(), hashes.summary()});
  EXPECT_GT(tracer.recorded(), 1500u);
  EXPECT_EQ(tracer.dropped(), 0u);
}

TEST(Vehicle, NavStatesComeAtOneHundredHertz) {
  const Replayed r = replay(DataClock::virtual_time(), fake_sensors(5.0));
  const double ticks = static_cast<double>(r.channels.at("NAV_STATE").count);
  EXPECT_NEAR(ticks / r.report.data_seconds, 100.0, 0.5);
}

TEST(Vehicle, NothingIsLostAndRingsBalance) {
  const Replayed r = replay(DataClock::virtual_time(), fake_sensors(20.0));
  expect_rings_balance(r.report);
  for (const RingHealth& ring : r.report.health.rings) {
    EXPECT_EQ(ring.lost + ring.held, 0u) << ring.name;
  }
}

TEST(Vehicle, StopEndsInOrderAndPublishesWhatThereIs) {
  ChannelHashes hashes;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(3600.0), DataClock::paced(1.0), {&hashes},
                  {});
  vehicle.start();
  while (vehicle.position() < vehicle.first() + std::chrono::milliseconds(300)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(vehicle.running());
  vehicle.stop();
  vehicle.wait();
  EXPECT_FALSE(vehicle.running());
  expect_rings_balance(vehicle.report());
  EXPECT_GE(hashes.summary().at("NAV_STATE").count, 30u);
}

TEST(Vehicle, ADriverThatFailsIsNamedAndTheRestGoesOn) {
  Sensors sensors = fake_sensors(3.0);
  sensors.imu = std::make_unique<testing::BrokenSource<ImuSample>>(std::move(sensors.imu), 100);
  const Replayed r = replay(DataClock::virtual_time(), std::move(sensors));
  EXPECT_EQ(r.channels.at("IMU").count, 100u);
  EXPECT_EQ(r.channels.at("VO").count, 30u);
  std::string said;
  for (const std::string& sentence : r.report.health.degraded) said += sentence;
  EXPECT_NE(said.find("imu has ended: cable pulled"), std::string::npos) << said;
}

TEST(Vehicle, ALoaderThatFailsIsNamedAndTheRestGoesOn) {
  Sensors sensors = fake_sensors(3.0);
  sensors.camera =
      std::make_unique<testing::BrokenSource<StereoPair>>(std::move(sensors.camera), 7);
  const Replayed r = replay(DataClock::virtual_time(), std::move(sensors));
  EXPECT_EQ(r.channels.at("VO").count, 7u);
  EXPECT_EQ(r.channels.at("IMU").count, 300u);
  std::string said;
  for (const std::string& sentence : r.report.health.degraded) said += sentence;
  EXPECT_NE(said.find("camera has ended: cable pulled"), std::string::npos) << said;
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
  const Replayed r = replay(DataClock::virtual_time(), std::move(sensors));
  EXPECT_EQ(r.channels.at("IMU").count, 200u);
  EXPECT_EQ(r.channels.count("VO"), 0u);
  EXPECT_EQ(r.channels.count("TRUTH"), 0u);
}

TEST(Vehicle, ADriveWithoutASingleSampleIsAnError) {
  Vehicle vehicle({}, fake_calibration(), Sensors{}, DataClock::virtual_time(), {}, {});
  EXPECT_THROW(vehicle.start(), std::runtime_error);
}

TEST(Vehicle, EveryThreadSaysHowItKeptItsTime) {
  const Replayed r = replay(DataClock::paced(1.0), fake_sensors(2.5));
  const auto names = [](const std::vector<LatencySummary>& summaries) {
    std::string all;
    for (const LatencySummary& s : summaries) all += s.name + ' ';
    return all;
  };
  EXPECT_EQ(names(r.report.deadlines.threads), "stereo lidar fusion ");
  EXPECT_EQ(names(r.report.deadlines.wake_up),
            "camera velodyne imu gnss reference stereo lidar fusion health ");
  EXPECT_EQ(names(r.report.deadlines.execution), "stereo lidar fusion publisher health ");
  EXPECT_EQ(names(r.report.deadlines.period_jitter), "fusion health ");
  double cpu = 0.0;
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_GT(thread.cpu, 0.0) << thread.name;
    EXPECT_EQ(thread.left_out, thread.name == "health" ? thread.left_out : 0u) << thread.name;
    cpu += thread.cpu;
  }
  EXPECT_EQ(r.report.health.threads.size(), 10u) << "five drivers, three stages, publisher, health";
  EXPECT_LE(cpu, r.report.health.cpu);
  EXPECT_GE(r.report.health.elapsed, 2.4);
}

TEST(Vehicle, MissedDeadlinesComeWithWhereTheTimeWent) {
  // Far too fast for the images: stereo must miss, and the data clock must wait for it.
  const Replayed r = replay(DataClock::paced(2000.0), fake_sensors(5.0));
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
