// Tests the closed loop through the road map: the mapmatch thread feeds back to the fusion thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "runtime/vehicle/stages/road_map.h"
#include "tests/mapmatch/small_map.h"
#include "tests/runtime/vehicle/driven.h"

namespace maploop::vehicle::map_loop_test {
namespace {

using maploop::testing::SmallMap;
using std::chrono::milliseconds;
using testing::Drive;
using testing::drive;
using testing::drive_start;
using testing::Driven;
using testing::fake_sensors;

constexpr double road_east = 1.0;  // m, from the vehicle's path: the error of the map

// The fake drive goes north from 49 N 8.4 E at 10 m/s.
std::shared_ptr<const RoadMap> north_road() {
  static const auto map = std::make_shared<const RoadMap>(
      RoadMap{SmallMap().node(1, road_east, -50).node(2, road_east, 400).way(10, {1, 2}).network(),
              mapmatch::read_rule_bases(mapmatch::default_rules())});
  return map;
}

Drive in(MapMode mode, double seconds = 9.0) {
  Drive d{.sensors = fake_sensors(seconds), .map = north_road()};
  d.config.map.mode = mode;
  return d;
}

std::size_t fed(const Driven& run) {
  return static_cast<std::size_t>(
      std::count_if(run.feedbacks.begin(), run.feedbacks.end(),
                    [](const MapFeedback& f) { return f.position || f.azimuth; }));
}

TEST(MapLoop, TightDrawsTheStateToTheRoadAndSaysSoAndLooseFeedsNothingBack) {
  const Driven loose = drive(in(MapMode::loose)), tight = drive(in(MapMode::tight));
  EXPECT_TRUE(loose.feedbacks.empty());
  EXPECT_FALSE(loose.channels.contains("MAP_FEEDBACK"));
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

  Drive in_real_time = in(MapMode::tight);
  in_real_time.speed = 6.0;
  EXPECT_EQ(drive(std::move(in_real_time)).hashes(), tight.hashes());
}

TEST(MapLoop, AHardResetIsOnTheRoad) {
  const Driven run = drive(in(MapMode::hard_reset));
  EXPECT_GE(fed(run), 20U);
  EXPECT_NEAR(run.states.back().position_enu.x(), road_east, 0.7);
}

TEST(MapLoop, AResumedRunSendsWhatTheWholeRunSends) {
  Drive d = in(MapMode::tight);  // cuts at, before and after ticks of the matcher, and feedback
  for (const int ms : {100, 3010, 5000, 5090, 7000, 7010})
    d.cuts.push_back(drive_start + milliseconds(ms));
  const Driven whole = drive(std::move(d));
  ASSERT_EQ(whole.snapshots.size(), 6u);
  testing::expect_resumes(whole, [](const Snapshot* from) {
    Drive rest = in(MapMode::tight);
    rest.from = from;
    return drive(std::move(rest));
  });
}

TEST(MapLoop, ASnapshotOfAnotherModeIsRefused) {
  Drive loose = in(MapMode::loose, 1.0), tight = in(MapMode::tight, 1.0);
  loose.cuts = {drive_start + milliseconds(500)};
  const Driven run = drive(std::move(loose));
  tight.from = &run.snapshots.at(0);
  EXPECT_THROW(drive(std::move(tight)), ArchiveError);
}

}  // namespace
}  // namespace maploop::vehicle::map_loop_test
