// Tests the vehicle with a road map: what the mapmatch thread adds to the graph, and what it does
// not change.
#include <gtest/gtest.h>

#include <maploop_lcm/map_match_t.hpp>
#include <memory>
#include <utility>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/mapmatch/small_map.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle::map_match_test {
namespace {

using maploop::testing::error_of;
using maploop::testing::SmallMap;
using std::chrono::milliseconds;
using testing::Drive;
using testing::drive;
using testing::drive_start;
using testing::Driven;
using testing::expect_resumes;
using testing::expect_rings_balance;
using testing::fake_sensors;
using ::testing::HasSubstr;

// The fake drive goes north from 49 N 8.4 E at 10 m/s.
std::shared_ptr<const RoadMap> north_road() {
  static const auto map = std::make_shared<const RoadMap>(RoadMap{
      SmallMap().node(1, 0, -50).node(2, 0, 400).node(3, 200, 400).way(10, {1, 2, 3}).network(),
      mapmatch::read_rule_bases(mapmatch::default_rules())});
  return map;
}

// Returns visual odometry that follows the drive, or turns although the drive does not.
std::unique_ptr<sensors::Source<RelativeMotion>> visual_odometry(double yaw_rate) {
  return testing::fake_source<RelativeMotion>(
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

Drive with_map(Sensors sensors = fake_sensors(6.0)) {
  return {.sensors = std::move(sensors), .map = north_road()};
}

TEST(VehicleMapMatch, MatchesEveryTenthStateAndSaysItInNumbersAndWords) {
  const Driven run = drive(with_map());
  ASSERT_GE(run.matches.size(), 59U);
  EXPECT_EQ(run.channels.at("MAP_MATCH").count, run.matches.size());
  for (std::size_t i = 1; i < run.matches.size(); ++i) {
    EXPECT_EQ(run.matches[i].sequence, i);
    EXPECT_EQ(run.matches[i].available - run.matches[i].stamp,
              stages::fusion.budget + stages::mapmatch.budget)
        << "the state of the tick just before";
  }
  const MapMatch& last = run.matches.at(45);
  ASSERT_TRUE(last.on_road);
  EXPECT_EQ(last.way_id, 10);
  EXPECT_EQ(last.phase, MatchPhase::along_link);
  EXPECT_GT(last.probability, 0.9);

  const auto& data = run.messages.at("MAP_MATCH").at(45).data;
  maploop_lcm::map_match_t message;
  ASSERT_GT(message.decode(data.data(), 0, static_cast<int>(data.size())), 0);
  EXPECT_THAT(message.explanation, ::testing::StartsWith("way 10, P "));
  ASSERT_GE(message.candidate_count, 1);
  EXPECT_EQ(message.candidates[0].road, "way 10");
  EXPECT_GE(message.candidates[0].rule_count, 1);
  EXPECT_EQ(from_lcm(message).cross_track, run.matches.at(45).cross_track);
}

TEST(VehicleMapMatch, ChangesNoBitOfTheRestAndIsTheSameInRealTime) {
  const auto without = drive({.sensors = fake_sensors(6.0)}).hashes();
  auto lockstep = drive(with_map()).hashes();
  Drive in_real_time = with_map();
  in_real_time.speed = 4.0;
  const Driven paced = drive(std::move(in_real_time));
  EXPECT_EQ(paced.hashes(), lockstep);
  EXPECT_EQ(lockstep.erase("MAP_MATCH"), 1u);
  EXPECT_EQ(without, lockstep);
  expect_rings_balance(paced.report, true);
}

TEST(VehicleMapMatch, AResumedRunSendsWhatTheWholeRunSends) {
  Drive d = with_map();  // cuts at, before and after ticks of the matcher
  for (const int ms : {100, 500, 1230, 3010, 3090, 4500})
    d.cuts.push_back(drive_start + milliseconds(ms));
  const Driven whole = drive(std::move(d));
  ASSERT_EQ(whole.snapshots.size(), 6u);
  expect_resumes(whole, [](const Snapshot* from) {
    Drive rest = with_map();
    rest.from = from;
    return drive(std::move(rest));
  });
}

TEST(VehicleMapMatch, VisualOdometryIsAskedTooWithTheSameBitsInEachRun) {
  Drive d = with_map(with_visual_odometry());
  d.cuts = {drive_start + milliseconds(3010)};
  const Driven lockstep = drive(std::move(d));
  std::size_t asked = 0;
  for (const MapMatch& match : lockstep.matches)
    asked += match.candidates[0].rules == RuleBase::along_visual;
  EXPECT_GE(asked, 20U);
  EXPECT_EQ(lockstep.matches.at(55).candidates[0].rules, RuleBase::along_visual);
  EXPECT_GT(lockstep.matches.at(55).candidates[0].weights[18], 0.9F)
      << "fast and no turn in the images";

  Drive in_real_time = with_map(with_visual_odometry());
  in_real_time.speed = 4.0;
  EXPECT_EQ(drive(std::move(in_real_time)).hashes(), lockstep.hashes());

  ASSERT_EQ(lockstep.snapshots.size(), 1u);
  expect_resumes(lockstep, [](const Snapshot* from) {
    Drive rest = with_map(with_visual_odometry());
    rest.from = from;
    return drive(std::move(rest));
  });
}

TEST(VehicleMapMatch, VisualOdometryThatContradictsTheStateIsNotAsked) {
  const Driven run = drive(with_map(with_visual_odometry(radians(20.0))));
  for (const MapMatch& match : run.matches) {
    for (std::size_t i = 0; i < match.candidate_count; ++i)
      ASSERT_NE(match.candidates[i].rules, RuleBase::along_visual) << match.sequence;
  }
}

TEST(VehicleMapMatch, ASnapshotWithoutAMapIsRefusedWhereThereIsOne) {
  for (const bool map : {false, true}) {
    Drive saved = with_map(fake_sensors(1.0)), resumed = with_map(fake_sensors(1.0));
    (map ? resumed : saved).map = nullptr;
    saved.cuts = {drive_start + milliseconds(500)};
    const Driven run = drive(std::move(saved));
    resumed.from = &run.snapshots.at(0);
    EXPECT_THROW(drive(std::move(resumed)), ArchiveError);
  }
}

TEST(VehicleMapMatch, StatesWithoutAPositionAreCounted) {
  Sensors sensors = fake_sensors(3.0);
  sensors.gnss = nullptr;
  EXPECT_GE(drive(with_map(std::move(sensors))).refused("mapmatch", "there is no position yet"),
            28U);
}

TEST(RoadMap, IsThereWhereTheConfigurationSaysSo) {
  const maploop::testing::TemporaryFolder folder;
  MapParameters parameters;
  EXPECT_EQ(load_road_map(parameters), nullptr);
  parameters.file = (folder.path() / "none.osm.pbf").string();
  EXPECT_THAT(error_of([&] { load_road_map(parameters); }), HasSubstr("none.osm.pbf"));
  parameters.mode = MapMode::none;
  EXPECT_EQ(load_road_map(parameters), nullptr);
}

}  // namespace
}  // namespace maploop::vehicle::map_match_test
