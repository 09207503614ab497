// Tests the vehicle with a road map: what the mapmatch thread adds to the graph, and what it does
// not change.
#include <gtest/gtest.h>

#include <map>
#include <maploop_lcm/map_match_t.hpp>
#include <memory>
#include <string>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/mapmatch/small_map.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/message_tape.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle::map_match_test {
namespace {

using maploop::testing::MessageTape;
using maploop::testing::SmallMap;
using runtime::DataClock;
using std::chrono::milliseconds;
using testing::drive_start;
using testing::fake_calibration;
using testing::fake_sensors;

// The fake drive goes north from 49 N 8.4 E at 10 m/s.
std::shared_ptr<const RoadMap> north_road() {
  static const auto map = std::make_shared<const RoadMap>(RoadMap{
      SmallMap().node(1, 0, -50).node(2, 0, 400).node(3, 200, 400).way(10, {1, 2, 3}).network(),
      mapmatch::read_rule_bases(mapmatch::default_rules())});
  return map;
}

// Returns visual odometry that follows the drive, or turns although the drive does not.
std::unique_ptr<sensors::Source<RelativeMotion>> visual_odometry(double yaw_rate) {
  return std::make_unique<testing::FakeSource<RelativeMotion>>(
      60, [yaw_rate](std::uint64_t i, RelativeMotion& motion) {
        motion.from = drive_start + i * milliseconds(100);
        motion.stamp = motion.from + milliseconds(100);
        motion.available = motion.stamp + milliseconds(55);
        motion.status = OdometryStatus::ok;
        motion.translation.x() = 1.0;
        motion.rotation = Eigen::AngleAxisd(0.1 * yaw_rate, Eigen::Vector3d::UnitZ());
        motion.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
      });
}

Sensors with_visual_odometry(double yaw_rate = 0.0) {
  Sensors sensors = fake_sensors(6.0);
  sensors.camera = nullptr;
  sensors.odometry = visual_odometry(yaw_rate);
  sensors.visual = visual_odometry(yaw_rate);
  return sensors;
}

struct Driven {
  std::map<std::string, ChannelSummary> channels;
  MessageTape::Channels tape;
  std::vector<MapMatch> matches;
  std::vector<Snapshot> snapshots;
  VehicleReport report;
};

Driven drive(const DataClock& clock, std::shared_ptr<const RoadMap> map,
             const std::vector<Time>& cuts = {}, const Snapshot* from = nullptr,
             Sensors sensors = fake_sensors(6.0)) {
  Driven run;
  ChannelHashes hashes;
  MessageTape tape;
  Observer observer;
  observer.map_match = [&](const MapMatch& match) { run.matches.push_back(match); };
  Vehicle vehicle({}, fake_calibration(), std::move(sensors), clock, {&hashes, &tape}, observer,
                  nullptr, std::move(map));
  if (from != nullptr) vehicle.resume(*from);
  vehicle.take_snapshots(cuts, [&](const Snapshot& s) { run.snapshots.push_back(s); });
  vehicle.start();
  vehicle.wait();
  run.channels = hashes.summary();
  run.tape = tape.all();
  run.report = vehicle.report();
  return run;
}

TEST(VehicleMapMatch, MatchesEveryTenthStateOfTheFusion) {
  const Driven run = drive(DataClock::virtual_time(), north_road());
  ASSERT_GE(run.matches.size(), 59U);
  EXPECT_EQ(run.channels.at("MAP_MATCH").count, run.matches.size());
  for (std::size_t i = 1; i < run.matches.size(); ++i) {
    EXPECT_EQ(run.matches[i].sequence, i);
    EXPECT_EQ(run.matches[i].available - run.matches[i].stamp,
              stages::fusion.budget + stages::mapmatch.budget)
        << "the state of the tick just before";
  }
  const MapMatch& last = run.matches.at(55);
  ASSERT_TRUE(last.on_road);
  EXPECT_EQ(last.way_id, 10);
  EXPECT_EQ(last.phase, MatchPhase::along_link);
  EXPECT_GT(last.probability, 0.9);
}

TEST(VehicleMapMatch, TheMessageSaysItInNumbersAndWords) {
  const Driven run = drive(DataClock::virtual_time(), north_road());
  const auto& data = run.tape.at("MAP_MATCH").at(55).data;
  maploop_lcm::map_match_t message;
  ASSERT_GT(message.decode(data.data(), 0, static_cast<int>(data.size())), 0);
  EXPECT_EQ(message.explanation.find("way 10, P "), 0U) << message.explanation;
  ASSERT_GE(message.candidate_count, 1);
  EXPECT_EQ(message.candidates[0].road, "way 10");
  EXPECT_GE(message.candidates[0].rule_count, 1);
  EXPECT_EQ(from_lcm(message).cross_track, run.matches.at(55).cross_track);
}

TEST(VehicleMapMatch, ChangesNoBitOfTheRestAndIsTheSameInRealTime) {
  const Driven without = drive(DataClock::virtual_time(), nullptr);
  const Driven lockstep = drive(DataClock::virtual_time(), north_road());
  const Driven paced = drive(DataClock::paced(4.0), north_road());
  EXPECT_FALSE(without.channels.contains("MAP_MATCH"));
  for (const auto& [name, channel] : lockstep.channels) {
    if (channel.hash.empty()) continue;
    EXPECT_EQ(paced.channels.at(name).hash, channel.hash) << name;
    if (name == "MAP_MATCH") continue;
    EXPECT_EQ(without.channels.at(name).hash, channel.hash) << name;
  }
  for (const RingHealth& ring : paced.report.health.rings)
    EXPECT_EQ(ring.pushed, ring.popped) << ring.name;
}

TEST(VehicleMapMatch, AResumedRunSendsWhatTheWholeRunSends) {
  std::vector<Time> cuts;  // at, before and after ticks of the matcher
  for (const int ms : {100, 500, 1230, 3010, 3090, 4500})
    cuts.push_back(drive_start + milliseconds(ms));
  const Driven whole = drive(DataClock::virtual_time(), north_road(), cuts);
  ASSERT_EQ(whole.snapshots.size(), cuts.size());
  for (const Snapshot& snapshot : whole.snapshots) {
    const Driven resumed = drive(DataClock::virtual_time(), north_road(), {}, &snapshot);
    std::vector<MessageTape::Taped> expected;
    for (const auto& taped : whole.tape.at("MAP_MATCH"))
      if (taped.time > snapshot.at) expected.push_back(taped);
    EXPECT_EQ(resumed.tape.at("MAP_MATCH"), expected) << format_time(snapshot.at);
  }
}

TEST(VehicleMapMatch, VisualOdometryIsAskedTooWithTheSameBitsInEachRun) {
  const std::vector<Time> cuts{drive_start + milliseconds(3010)};
  const Driven lockstep =
      drive(DataClock::virtual_time(), north_road(), cuts, nullptr, with_visual_odometry());
  std::size_t asked = 0;
  for (const MapMatch& match : lockstep.matches)
    asked += match.candidates[0].rules == RuleBase::along_visual;
  EXPECT_GE(asked, 20U);
  EXPECT_EQ(lockstep.matches.at(55).candidates[0].rules, RuleBase::along_visual);
  EXPECT_GT(lockstep.matches.at(55).candidates[0].weights[18], 0.9F)
      << "fast and no turn in the images";

  const Driven paced =
      drive(DataClock::paced(4.0), north_road(), {}, nullptr, with_visual_odometry());
  EXPECT_EQ(paced.channels.at("MAP_MATCH").hash, lockstep.channels.at("MAP_MATCH").hash);

  const Driven resumed = drive(DataClock::virtual_time(), north_road(), {},
                               &lockstep.snapshots.at(0), with_visual_odometry());
  std::vector<MessageTape::Taped> expected;
  for (const auto& taped : lockstep.tape.at("MAP_MATCH"))
    if (taped.time > lockstep.snapshots.at(0).at) expected.push_back(taped);
  EXPECT_EQ(resumed.tape.at("MAP_MATCH"), expected);
}

TEST(VehicleMapMatch, VisualOdometryThatContradictsTheStateIsNotAsked) {
  const Driven run = drive(DataClock::virtual_time(), north_road(), {}, nullptr,
                           with_visual_odometry(radians(20.0)));
  for (const MapMatch& match : run.matches)
    for (std::size_t i = 0; i < match.candidate_count; ++i)
      ASSERT_NE(match.candidates[i].rules, RuleBase::along_visual) << match.sequence;
}

TEST(VehicleMapMatch, ASnapshotWithoutAMapIsRefusedWhereThereIsOne) {
  const Driven without =
      drive(DataClock::virtual_time(), nullptr, {drive_start + milliseconds(500)});
  EXPECT_THROW(drive(DataClock::virtual_time(), north_road(), {}, &without.snapshots.at(0)),
               ArchiveError);
  const Driven with =
      drive(DataClock::virtual_time(), north_road(), {drive_start + milliseconds(500)});
  EXPECT_THROW(drive(DataClock::virtual_time(), nullptr, {}, &with.snapshots.at(0)), ArchiveError);
}

TEST(VehicleMapMatch, StatesWithoutAPositionAreCounted) {
  Sensors sensors = fake_sensors(3.0);
  sensors.gnss = nullptr;
  Vehicle vehicle({}, fake_calibration(), std::move(sensors), DataClock::virtual_time(), {}, {},
                  nullptr, north_road());
  vehicle.start();
  vehicle.wait();
  std::uint64_t counted = 0;
  for (const RefusalCount& r : vehicle.report().health.refusals)
    if (r.stage == "mapmatch" && r.reason == "there is no position yet") counted = r.count;
  EXPECT_GE(counted, 28U);
}

TEST(RoadMap, IsThereWhereTheConfigurationSaysSo) {
  const maploop::testing::TemporaryFolder folder;
  MapParameters parameters;
  EXPECT_EQ(load_road_map(parameters), nullptr);
  parameters.file = (folder.path() / "none.osm.pbf").string();
  try {
    load_road_map(parameters);
    FAIL() << "loaded";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("none.osm.pbf"), std::string::npos) << e.what();
  }
  parameters.mode = MapMode::none;
  EXPECT_EQ(load_road_map(parameters), nullptr);
}

}  // namespace
}  // namespace maploop::vehicle::map_match_test
