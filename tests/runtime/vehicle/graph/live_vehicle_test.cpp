// The graph on live sensors that come, stay away, flood it and go.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/imu/ncom_packet.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/runtime/vehicle/memory_bus.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::MemoryBus;

// Delivers a sample each period; never, where that is 0.
template <class T>
class FakeLiveSource final : public sensors::LiveSource<T> {
 public:
  FakeLiveSource(
      const sensors::HostClock& clock, Duration period, std::function<void(T&)> fill = [](T&) {})
      : clock_(clock), period_(period), fill_(std::move(fill)), next_(clock.now()) {}

  bool wait(T& sample, Duration patience) override {
    const bool comes = period_ > Duration::zero() && next_ - clock_.now() <= patience;
    std::this_thread::sleep_for(comes ? next_ - clock_.now() : patience);
    if (!comes) return false;
    next_ += period_;
    fill_(sample);
    sample.stamp = sample.available = clock_.now();
    sample.sequence = delivered_++;
    return true;
  }
  sensors::LiveReport report() const override {
    sensors::LiveReport report;
    report.endpoint = "udp://:1";
    report.delivered = delivered_;
    report.connection.open = period_ > Duration::zero();
    if (!report.connection.open) report.connection.problem = "is not there; is it plugged in?";
    report.clock = {true, {}, 1e-6, {}, 0};
    return report;
  }

 private:
  const sensors::HostClock& clock_;
  Duration period_;
  std::function<void(T&)> fill_;
  Time next_;
  std::uint64_t delivered_ = 0;
};

void fill_fix(GnssFix& fix) {
  fix.position = {radians(49.0), radians(8.4), 110.0};
  fix.position_covariance = Eigen::Matrix3d::Identity();
  fix.velocity_enu = {0.0, 10.0, 0.0};
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  fix.velocity_stamp = sensors::HostClock().now();
}

LiveSensors live_sensors(Time (*utc)() = sensors::HostClock::machine_utc) {
  LiveSensors s;
  s.clock = std::make_shared<const sensors::HostClock>(utc);
  s.imu = std::make_unique<FakeLiveSource<ImuSample>>(*s.clock, milliseconds(10));
  s.gnss = std::make_unique<FakeLiveSource<GnssFix>>(*s.clock, milliseconds(200), fill_fix);
  return s;
}

// Drives until so many states have been sent, at least for `length`.
VehicleReport drive(MemoryBus& bus, LiveSensors live, Duration length, std::size_t states,
                    const StageDelays& delays = {}) {
  Sensors sensors;
  sensors.live = std::move(live);
  Vehicle vehicle({}, {}, std::move(sensors), runtime::DataClock::live(), {&bus}, {});
  vehicle.slow_down(delays);
  vehicle.start();
  std::this_thread::sleep_for(length);
  EXPECT_TRUE(bus.wait_for("NAV_STATE", states));
  EXPECT_TRUE(vehicle.running());
  vehicle.stop();
  vehicle.wait();
  return vehicle.report();
}

TEST(LiveVehicle, GoesOnWithoutASensorThatIsMissingAndNamesIt) {
  LiveSensors live = live_sensors();
  live.velodyne = std::make_unique<FakeLiveSource<LidarScan>>(*live.clock, Duration::zero());
  MemoryBus bus;
  const VehicleReport report = drive(bus, std::move(live), milliseconds(1500), 130);
  const auto states = bus.decoded<maploop_lcm::nav_state_t>("NAV_STATE");
  ASSERT_GT(states.size(), 100u);
  std::size_t aided = 0;
  for (const auto& state : states) aided += from_lcm(state).status != NavStatus::uninitialized;
  EXPECT_GT(aided, 50u);
  EXPECT_GT(bus.decoded<maploop_lcm::imu_t>("IMU").size(), 100u);
  EXPECT_THAT(report.health.degraded,
              Contains(HasSubstr("velodyne: udp://:1 is not there; is it plugged in?")));
  EXPECT_THAT(report.health.degraded, Contains(HasSubstr("velodyne: silent since the start")));
  EXPECT_EQ(report.stalls, 0u);
  ASSERT_EQ(report.health.sensors.size(), 3u);
  for (const SensorHealth& sensor : report.health.sensors) {
    EXPECT_EQ(sensor.connected, sensor.name != "velodyne") << sensor.name;
    EXPECT_EQ(sensor.delivered > 0, sensor.name != "velodyne") << sensor.name;
    EXPECT_TRUE(sensor.clock.known);
  }
  testing::expect_rings_balance(report);
}

std::atomic<bool> clock_was_set{false};

TEST(LiveVehicle, NoStampMovesWhenTheMachinesClockIsSet) {
  const auto utc = [] {
    return sensors::HostClock::machine_utc() +
           (clock_was_set ? milliseconds(1000) : milliseconds(0));
  };
  MemoryBus bus;
  clock_was_set = false;
  std::jthread setter([] {
    std::this_thread::sleep_for(milliseconds(500));
    clock_was_set = true;
  });
  const VehicleReport report = drive(bus, live_sensors(utc), milliseconds(1500), 130);
  EXPECT_THAT(report.health.degraded, Contains(HasSubstr("this machine's clock was set by 1.0")));
  const auto states = bus.decoded<maploop_lcm::nav_state_t>("NAV_STATE");
  ASSERT_GT(states.size(), 100u);
  for (std::size_t i = 1; i < states.size(); ++i) {
    const Duration between = from_lcm(states[i]).stamp - from_lcm(states[i - 1]).stamp;
    ASSERT_GT(between, Duration::zero());
    ASSERT_LT(between, milliseconds(900)) << "not the second that the clock was set by";
  }
  for (const RingHealth& ring : report.health.rings) EXPECT_EQ(ring.lost, 0u) << ring.name;
}

TEST(LiveVehicle, AStageThatIsTooSlowLosesItsOwnSamplesAloneAndShedsLoad) {
  LiveSensors live = live_sensors();
  live.velodyne = std::make_unique<FakeLiveSource<LidarScan>>(
      *live.clock, milliseconds(20), [](LidarScan& scan) { scan.points.assign(100, {}); });
  MemoryBus bus;
  StageDelays delays;
  std::atomic<std::uint64_t> struck{0};
  delays["lidar"].add({}, milliseconds(300), struck);
  const VehicleReport report = drive(bus, std::move(live), milliseconds(3000), 60, delays);
  for (const RingHealth& ring : report.health.rings) {
    EXPECT_EQ(ring.lost > 0, ring.name == "velodyne -> lidar") << ring.name;
  }
  EXPECT_EQ(report.stalls, 0u);
  EXPECT_GT(bus.decoded<maploop_lcm::nav_state_t>("NAV_STATE").size(), 50u);
  EXPECT_THAT(report.health.degraded, Contains(HasSubstr("overload: only one of")));
  for (const ThreadHealth& thread : report.health.threads) {
    EXPECT_EQ(thread.shed > 0, thread.name == "velodyne") << thread.name;
  }
}

TEST(LiveVehicle, GoesOnThroughUnpluggingAndAFloodOfGarbage) {
  const maploop::testing::TemporaryFolder folder;
  const auto device = folder.path() / "gnss";
  const std::uint16_t port = maploop::testing::free_port();
  VehicleConfig config;
  config.live.imu = "udp://:" + std::to_string(port);
  config.live.gnss = "serial://" + device.string();
  Sensors live;
  live.live = open_live_sensors(config);
  MemoryBus bus;
  Vehicle vehicle(config, {}, std::move(live), runtime::DataClock::live(), {&bus}, {});
  vehicle.start();
  const maploop::testing::UdpSender unit(port);
  const std::vector<std::uint8_t> garbage(72, 0xe7);
  std::uint16_t ms = 0;
  for (int plugged = 0; plugged < 2; ++plugged) {
    const maploop::testing::PseudoTerminal line(device);
    for (int i = 0; i < 60; ++i) {
      unit.send(sensors::ncom_packet(ms += 10, {}));
      for (int k = 0; k < 50; ++k) unit.send(garbage);
      if (i % 30 == 25) line.send("garbage\r\n" + maploop::testing::epoch(10 * plugged + i / 30));
      std::this_thread::sleep_for(milliseconds(10));
    }
  }
  std::this_thread::sleep_for(milliseconds(400));
  vehicle.stop();
  vehicle.wait();
  const VehicleReport report = vehicle.report();
  for (const SensorHealth& sensor : report.health.sensors) {
    EXPECT_EQ(sensor.connections, sensor.name == "gnss" ? 2u : 1u) << sensor.name;
    EXPECT_GT(sensor.delivered, 0u) << sensor.name;
    EXPECT_GT(sensor.refused, 0u) << sensor.name;
  }
  EXPECT_THAT(report.health.degraded, Contains(HasSubstr("gnss: serial://"))) << "it is unplugged";
  EXPECT_GT(bus.decoded<maploop_lcm::nav_state_t>("NAV_STATE").size(), 150u);
}

TEST(LiveConfig, NamesTheKeyThatIsWrong) {
  const auto error = [](auto&& set) {
    VehicleConfig config;
    if constexpr (requires { set(config.live); }) {
      set(config.live);
    } else {
      config.live.velodyne = "udp://:2368";
      set(config.vehicle);
    }
    return maploop::testing::error_of([&] {
      open_live_sensors(config);
      live_calibration(config);
    });
  };
  using P = LiveParameters;
  EXPECT_THAT(error([](P&) {}), HasSubstr("has no live sensor"));
  EXPECT_THAT(error([](P& p) { p.imu = "udp:3000"; }), HasSubstr("[live] imu: "));
  using D = VehicleDescription;
  EXPECT_THAT(error([](D& d) { d.lidar.model = "HDL-64E"; }),
              HasSubstr("[live] velodyne: each HDL-64E has its own lasers"));
  EXPECT_THAT(error([](D& d) { d.lidar.model = "VLP-17"; }),
              HasSubstr("[vehicle.lidar] model: is \"VLP-17\"; allowed is"));
  EXPECT_THAT(error([](P& p) { p.camera_left = "videotestsrc"; }),
              HasSubstr("[live] camera_left: the cameras' calibration is missing"));
  EXPECT_THAT(error([](P& p) { p.camera_right = "videotestsrc"; }),
              HasSubstr("camera_right needs camera_left"));
  EXPECT_THAT(error([](P& p) { p.imu = "udp://:3000", p.imu_protocol = "morse"; }),
              HasSubstr("[live] imu_protocol: is \"morse\"; allowed is"));
  EXPECT_THAT(error([](D& d) { d.camera.calibration = "/nowhere.toml"; }),
              HasSubstr("/nowhere.toml"));
}

}  // namespace
}  // namespace maploop::vehicle
