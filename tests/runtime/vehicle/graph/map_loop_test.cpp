// Tests the closed loop through the road map: the mapmatch thread feeds back to the fusion thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/output/channel_hashes.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/mapmatch/small_map.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/message_tape.h"

namespace maploop::vehicle::map_loop_test {
namespace {

using maploop::testing::MessageTape;
using maploop::testing::SmallMap;
using runtime::DataClock;
using std::chrono::milliseconds;
using testing::drive_start;
using testing::fake_calibration;
using testing::fake_sensors;

constexpr double road_east = 1.0;  // m, from the vehicle's path: the error of the map

// The fake drive goes north from 49 N 8.4 E at 10 m/s.
std::shared_ptr<const RoadMap> north_road() {
  static const auto map = std::make_shared<const RoadMap>(
      RoadMap{SmallMap().node(1, road_east, -50).node(2, road_east, 400).way(10, {1, 2}).network(),
              mapmatch::read_rule_bases(mapmatch::default_rules())});
  return map;
}

struct Driven {
  std::map<std::string, ChannelSummary> channels;
  MessageTape::Channels tape;
  std::vector<MapFeedback> feedbacks;
  std::vector<NavState> states;
  std::vector<Snapshot> snapshots;
};

Driven drive(MapMode mode, const DataClock& clock = DataClock::virtual_time(),
             const std::vector<Time>& cuts = {}, const Snapshot* from = nullptr) {
  Driven run;
  ChannelHashes hashes;
  MessageTape tape;
  Observer observer;
  observer.map_feedback = [&](const MapFeedback& f) { run.feedbacks.push_back(f); };
  observer.nav_state = [&](const NavState& s) { run.states.push_back(s); };
  VehicleConfig config;
  config.map.mode = mode;
  Sensors sensors = fake_sensors(9.0);
  Vehicle vehicle(config, fake_calibration(), std::move(sensors), clock, {&hashes, &tape}, observer,
                  nullptr, north_road());
  if (from != nullptr) vehicle.resume(*from);
  vehicle.take_snapshots(cuts, [&](const Snapshot& s) { run.snapshots.push_back(s); });
  vehicle.start();
  vehicle.wait();
  run.channels = hashes.summary();
  run.tape = tape.all();
  return run;
}

std::size_t fed(const Driven& run) {
  return static_cast<std::size_t>(
      std::count_if(run.feedbacks.begin(), run.feedbacks.end(),
                    [](const MapFeedback& f) { return f.position || f.azimuth; }));
}

TEST(MapLoop, LooseFeedsNothingBack) {
  const Driven run = drive(MapMode::loose);
  EXPECT_TRUE(run.feedbacks.empty());
  EXPECT_FALSE(run.channels.contains("MAP_FEEDBACK"));
}

TEST(MapLoop, TightDrawsTheStateToTheRoadAndSaysSo) {
  const Driven loose = drive(MapMode::loose);
  const Driven tight = drive(MapMode::tight);
  ASSERT_GE(tight.feedbacks.size(), 80U);
  EXPECT_GE(fed(tight), 3U);
  EXPECT_EQ(tight.channels.at("MAP_FEEDBACK").count, tight.feedbacks.size());
  for (const MapFeedback& f : tight.feedbacks) {
    EXPECT_EQ(f.position || f.azimuth, f.reason == FeedbackReason::none);
    if (f.stamp == tight.feedbacks.back().stamp) continue;  // the last tick comes after the states
    EXPECT_EQ(f.available - f.stamp, stages::fusion.budget + stages::mapmatch.budget);
  }
  const double off = loose.states.back().position_enu.x() - tight.states.back().position_enu.x();
  EXPECT_LT(off, -1e-4) << "the road is to the east";
  EXPECT_LT(tight.states.back().covariance(0, 0), loose.states.back().covariance(0, 0));
}

TEST(MapLoop, AHardResetIsOnTheRoad) {
  const Driven run = drive(MapMode::hard_reset);
  EXPECT_GE(fed(run), 20U);
  EXPECT_NEAR(run.states.back().position_enu.x(), road_east, 0.7);
}

TEST(MapLoop, InRealTimeHasTheBitsOfLockstep) {
  const Driven lockstep = drive(MapMode::tight);
  const Driven paced = drive(MapMode::tight, DataClock::paced(6.0));
  for (const auto& [name, channel] : lockstep.channels) {
    if (!channel.hash.empty()) {
      EXPECT_EQ(paced.channels.at(name).hash, channel.hash) << name;
    }
  }
}

TEST(MapLoop, AResumedRunSendsWhatTheWholeRunSends) {
  std::vector<Time> cuts;  // at, before and after ticks of the matcher, before and after feedback
  for (const int ms : {100, 3010, 5000, 5090, 7000, 7010})
    cuts.push_back(drive_start + milliseconds(ms));
  const Driven whole = drive(MapMode::tight, DataClock::virtual_time(), cuts);
  ASSERT_EQ(whole.snapshots.size(), cuts.size());
  for (const Snapshot& snapshot : whole.snapshots) {
    const Driven resumed = drive(MapMode::tight, DataClock::virtual_time(), {}, &snapshot);
    for (const char* channel : {"NAV_STATE", "MAP_MATCH", "MAP_FEEDBACK"}) {
      std::vector<MessageTape::Taped> expected;
      for (const auto& taped : whole.tape.at(channel))
        if (taped.time > snapshot.at) expected.push_back(taped);
      EXPECT_EQ(resumed.tape.at(channel), expected) << channel << ' ' << format_time(snapshot.at);
    }
  }
}

TEST(MapLoop, ASnapshotOfAnotherModeIsRefused) {
  const Driven loose =
      drive(MapMode::loose, DataClock::virtual_time(), {drive_start + milliseconds(500)});
  EXPECT_THROW(drive(MapMode::tight, DataClock::virtual_time(), {}, &loose.snapshots.at(0)),
               ArchiveError);
}

}  // namespace
}  // namespace maploop::vehicle::map_loop_test
