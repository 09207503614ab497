// Tests the loop through the road map with PPP: which data go where, and that none are used twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/support/message_tape.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::MessageTape;
using runtime::DataClock;
using std::chrono::milliseconds;
using std::chrono::seconds;

const Recording& riverside() {
  static const Recording recording = open_recording(
      maploop::testing::real_data() / "gnss/riverside_drive/COM3_200712.obs.gz", VehicleConfig{});
  return recording;
}

std::shared_ptr<const RoadMap> roads() {
  static const auto map = [] {
    MapParameters parameters;
    parameters.file =
        (maploop::testing::real_data() / "maps/riverside/riverside_from_2021_drives.osm.pbf")
            .string();
    return load_road_map(parameters);
  }();
  return map;
}

struct Driven {
  MessageTape::Channels messages;
  std::vector<PppState> ppp;
  std::vector<MapFeedback> feedbacks;
  std::vector<Snapshot> snapshots;
};

Driven drive(MapMode mode, const DataClock& clock = DataClock::virtual_time(),
             const std::vector<Time>& cuts = {}, const Snapshot* from = nullptr,
             Duration length = seconds(90)) {
  Driven run;
  MessageTape tape;
  Observer observer;
  observer.ppp = [&](const PppState& s) { run.ppp.push_back(s); };
  observer.map_feedback = [&](const MapFeedback& f) { run.feedbacks.push_back(f); };
  VehicleConfig config;
  config.map.mode = mode;
  Sensors sensors = riverside().sensors(Time::min());
  limit(sensors, riverside().first_stamp + length);
  Vehicle vehicle(config, riverside().calibration, std::move(sensors), clock, {&tape}, observer,
                  nullptr, roads());
  vehicle.take_snapshots(cuts, [&](const Snapshot& s) { run.snapshots.push_back(s); });
  if (from != nullptr) vehicle.resume(*from);
  vehicle.start();
  vehicle.wait();
  run.messages = tape.all();
  return run;
}

TEST(PppInTheLoop, FixesForTheFusionHoldNothingOfTheMapThatItGetsItself) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven loose = drive(MapMode::loose), tight = drive(MapMode::tight);
  ASSERT_GT(std::count_if(tight.feedbacks.begin(), tight.feedbacks.end(),
                          [](const MapFeedback& f) { return f.position; }),
            5);
  EXPECT_NE(tight.messages.at("NAV_STATE"), loose.messages.at("NAV_STATE")) << "fusion is aided";
  EXPECT_NE(tight.messages.at("PPP_STATE"), loose.messages.at("PPP_STATE")) << "PPP is aided";
  EXPECT_EQ(tight.messages.at("GNSS_FIX"), loose.messages.at("GNSS_FIX"))
      << "and its fixes are those without the map, bit for bit";
  EXPECT_LT(tight.ppp.back().position_covariance.trace(),
            loose.ppp.back().position_covariance.trace());
  EXPECT_TRUE(loose.feedbacks.empty());
}

TEST(PppInTheLoop, AStageThatEndsWithAnErrorLeavesTheRestGoingOn) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const std::string stage : {"ppp", "mapmatch"}) {
    FaultInjection faults({parse_fault("broken@" + stage + ":10")}, riverside().first_stamp);
    VehicleConfig config;
    config.map.mode = MapMode::tight;
    Sensors sensors = riverside().sensors(Time::min());
    limit(sensors, riverside().first_stamp + seconds(120));  // more epochs than the ring holds
    Vehicle vehicle(config, riverside().calibration, std::move(sensors), DataClock::virtual_time(),
                    {}, {}, nullptr, roads());
    vehicle.slow_down(faults.delays());
    vehicle.start();
    const MonotonicTime bound = runtime::monotonic_now() + std::chrono::minutes(5);
    while (vehicle.running() && runtime::monotonic_now() < bound) {
      std::this_thread::sleep_for(milliseconds(5));
    }
    EXPECT_FALSE(vehicle.running()) << stage;
    vehicle.stop();
    vehicle.wait();
    const VehicleReport report = vehicle.report();
    for (const ThreadHealth& thread : report.health.threads) {
      EXPECT_EQ(thread.failure, thread.name == stage ? "ended by an injected fault" : "");
      if (thread.name == "gnss") {
        EXPECT_GT(thread.count, 118u) << "the receiver is read to the end";
      }
    }
    if (stage == "mapmatch") {  // without ppp this drive has no input for fusion
      EXPECT_GT(report.data_seconds, 118.0);
    }
  }
}

TEST(PppInTheLoop, ASlowStageIsStruckAtEachEpoch) {
  MAPLOOP_REQUIRE_REAL_DATA();
  FaultInjection faults({parse_fault("slow@ppp,by=0.001")}, riverside().first_stamp);
  Sensors sensors = riverside().sensors(Time::min());
  limit(sensors, riverside().first_stamp + seconds(10));
  Vehicle vehicle({}, riverside().calibration, std::move(sensors), DataClock::virtual_time(), {},
                  {});
  vehicle.slow_down(faults.delays());
  vehicle.start();
  vehicle.wait();
  EXPECT_GE(faults.counts().at(0).struck, 10u);
}

TEST(PppInTheLoop, HasTheSameBitsInRealTimeAndResumed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::vector<Time> cuts{riverside().first_stamp + milliseconds(70'550)};  // with feedback
  const Driven whole = drive(MapMode::tight, DataClock::virtual_time(), cuts);
  ASSERT_EQ(whole.snapshots.size(), cuts.size());
  const Snapshot& snapshot = whole.snapshots.front();
  const Driven paced = drive(MapMode::tight, DataClock::paced(60.0));
  const Driven resumed = drive(MapMode::tight, DataClock::virtual_time(), {}, &snapshot);
  for (const char* channel : {"PPP_STATE", "GNSS_FIX", "MAP_FEEDBACK", "NAV_STATE"}) {
    EXPECT_EQ(paced.messages.at(channel), whole.messages.at(channel)) << channel;
    std::vector<MessageTape::Taped> expected;
    for (const auto& taped : whole.messages.at(channel))
      if (taped.time > snapshot.at) expected.push_back(taped);
    EXPECT_EQ(resumed.messages.at(channel), expected) << channel;
  }
}

}  // namespace
}  // namespace maploop::vehicle
