// Tests a receiver's observations on a loopback socket: the positions are those of the same
// observations in files.
#include "runtime/vehicle/drivers/live_gnss.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <thread>

#include "msgs/lcm/conversions.h"
#include "ppp/gnss_files.h"
#include "ppp/models/geodesy.h"
#include "ppp/ppp_setup.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/live/ntrip_client.h"
#include "tests/runtime/vehicle/memory_bus.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::MemoryBus;

// Returns the drive in Kamakura: the observations, and the ephemerides that the receiver decoded.
const ppp::GnssFiles& kamakura() {
  static const ppp::GnssFiles files = [] {
    const auto folder = maploop::testing::real_data() / "gnss/kamakura_kinematic";
    ppp::GnssFiles f;
    ppp::read_into(folder / "SEPT265G.21O.gz", f);
    ppp::read_into(folder / "SEPT2650.21P.gz", f);
    return f;
  }();
  return files;
}

// Returns all ephemerides, to be sent before the first epoch.
std::string ephemerides() {
  std::string bytes;
  for (const ppp::KeplerMessage& m : kamakura().navigation[0].kepler)
    bytes += maploop::testing::rtcm_ephemeris(m);
  return bytes;
}

std::string rawx(std::size_t epoch) {
  return maploop::testing::rawx_frame(kamakura().observations[0].epochs[epoch]);
}

VehicleConfig config_for(const maploop::testing::TcpServer& receiver) {
  VehicleConfig config;
  config.live.gnss = receiver.endpoint();
  config.live.gnss_protocol = GnssProtocol::observations;
  config.ppp.filter.systems = "GE";
  return config;
}

TEST(LiveReceiver, GivesThePositionsOfTheSameObservationsInFiles) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::size_t count = kamakura().observations[0].epochs.size();
  ASSERT_GT(count, 300U) << "the whole drive";
  maploop::testing::TcpServer receiver;
  const VehicleConfig config = config_for(receiver);
  Sensors sensors;
  sensors.live = open_live_sensors(config);
  MemoryBus bus;
  Vehicle vehicle(config, {}, std::move(sensors), runtime::DataClock::live(), {&bus}, {});
  vehicle.start();
  ASSERT_TRUE(receiver.answer());
  std::string recording = ephemerides();
  ASSERT_TRUE(receiver.send(recording));
  recording.clear();
  for (std::size_t i = 0; i < count; ++i) {
    // The connection is lost inside a frame, and the receiver goes on.
    if (i == 20) {
      receiver.send(rawx(i).substr(0, 50));
      ASSERT_TRUE(receiver.answer());
    }
    ASSERT_TRUE(receiver.send(rawx(i)));
    recording += rawx(i);
    if (i > 30) {
      EXPECT_TRUE(bus.wait_for("PPP_STATE", i - 30)) << "a full ring would lose epochs";
    }
  }
  EXPECT_TRUE(bus.wait_for("PPP_STATE", count));
  vehicle.stop();
  vehicle.wait();
  const auto states = bus.decoded<maploop_lcm::ppp_state_t>("PPP_STATE");
  ASSERT_EQ(states.size(), count);
  EXPECT_GT(bus.decoded<maploop_lcm::gnss_fix_t>("GNSS_FIX").size(), count - 5);
  const Health health = vehicle.report().health;
  ASSERT_EQ(health.sensors.size(), 1u);
  EXPECT_EQ(health.sensors[0].connections, 2u);
  EXPECT_EQ(health.sensors[0].delivered, count);

  ppp::GnssFiles files;
  files.navigation = kamakura().navigation;
  for (ppp::NavigationFile& file : files.navigation) file.ionosphere.clear();  // it is not sent
  ppp::parse_into(recording, "made.ubx", files);
  const ppp::PppSetup setup(files, {.parameters = config.ppp.filter});
  ppp::MapAidedFilter filter = setup.make_map_aided_filter();
  std::size_t positions = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ppp::PppSolution& expected = filter.process(setup.observations().epochs[i]);
    const PppState found = from_lcm(states[i]);
    ASSERT_EQ(found.status, expected.status) << i << ' ' << found.message;
    if (expected.status == PppStatus::none) continue;
    ++positions;
    // Files write ephemerides with 12 digits.
    EXPECT_LT((ppp::ecef_from_geodetic(found.position) - expected.position).norm(), 1e-4) << i;
  }
  EXPECT_GT(positions, count - 5);
}

// This is the status that a live vehicle sends of each epoch, and what its ppp stage has saved
// last.
struct LiveRun {
  std::vector<PppStatus> statuses;
  Bytes saved;
};

LiveRun live_run(const std::string& sent, std::size_t epochs, const Bytes* recalled) {
  maploop::testing::TcpServer receiver;
  const VehicleConfig config = config_for(receiver);
  Sensors sensors;
  sensors.live = open_live_sensors(config);
  MemoryBus bus;
  LiveRun run;
  Vehicle vehicle(config, {}, std::move(sensors), runtime::DataClock::live(), {&bus}, {});
  vehicle.take_snapshots(milliseconds(100), [&](const Snapshot& snapshot) {
    run.saved = *snapshot.part(stages::ppp.name);
  });
  if (recalled != nullptr) vehicle.recall(stages::ppp, *recalled);
  vehicle.start();
  EXPECT_TRUE(receiver.answer());
  EXPECT_TRUE(receiver.send(sent));
  EXPECT_TRUE(bus.wait_for("PPP_STATE", epochs));
  std::this_thread::sleep_for(milliseconds(300));  // until it is saved
  vehicle.stop();
  vehicle.wait();
  for (const auto& state : bus.decoded<maploop_lcm::ppp_state_t>("PPP_STATE")) {
    run.statuses.push_back(from_lcm(state).status);
  }
  return run;
}

TEST(LiveReceiver, ARestartKnowsTheMessagesOfSatellitesThatWereReceived) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::string before = ephemerides();
  for (std::size_t i = 0; i < 20; ++i) before += rawx(i);
  const LiveRun first = live_run(before, 20, nullptr);
  const std::string after = rawx(40) + rawx(41);
  const LiveRun cold = live_run(after, 2, nullptr), warm = live_run(after, 2, &first.saved);
  EXPECT_EQ(cold.statuses.at(0), PppStatus::none);
  EXPECT_NE(warm.statuses.at(0), PppStatus::none);
}

TEST(LiveReceiver, ReportsWhatItReceives) {
  MAPLOOP_REQUIRE_REAL_DATA();
  maploop::testing::TcpServer receiver;
  const sensors::HostClock clock;
  const auto source = listen_to_receiver(sensors::open_stream(receiver.endpoint()), {}, clock);
  GnssEpoch sample;
  std::thread connecting([&] { EXPECT_TRUE(receiver.answer()); });
  EXPECT_TRUE(maploop::testing::wait_until_open(*source, true));
  connecting.join();
  receiver.send("garbage\xb5\x62\x02\x15" + std::string(400, 'x') + ephemerides() + rawx(0) +
                rawx(1) + rawx(1));
  Time last{};
  for (int k = 0; k < 2; ++k) {
    ASSERT_TRUE(maploop::testing::wait_for(*source, sample));
    EXPECT_GT(sample.stamp, last);
    EXPECT_LE(sample.stamp, sample.available);
    EXPECT_EQ(sample.heard.kepler.empty(), k == 1);
    last = sample.available;
  }
  source->wait(sample, milliseconds(100));
  const sensors::LiveReport report = source->report();
  EXPECT_EQ(report.delivered, 2u);
  const std::string said = maploop::testing::all_of(report);
  for (const char* what : {" G, ", " E; ", " on two carriers", "satellites with ephemerides",
                           "UBX frames", "1 epochs not later", "frames with a wrong checksum"}) {
    EXPECT_THAT(said, HasSubstr(what));
  }
  ASSERT_TRUE(report.clock.known && report.clock.utc_ahead);
}

}  // namespace
}  // namespace maploop::vehicle
