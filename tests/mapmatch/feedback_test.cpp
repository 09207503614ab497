// These tests check on hand-made maps what is fed back, and the reason if nothing is.
#include "mapmatch/feedback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "mapmatch/matcher.h"
#include "msgs/frames.h"
#include "tests/mapmatch/default_rule_bases.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/broken_archives.h"
#include "tests/support/counted_allocations.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::drive;
using maploop::testing::rules;
using maploop::testing::SmallMap;

// The map is a street of 600 m from west to east (way 10) and one across its end (way 20).
SmallMap tee() {
  SmallMap map;
  map.node(1, 0, 0).node(2, 600, 0).node(3, 600, 300).node(4, 600, -300);
  map.way(10, {1, 2}).way(20, {4, 2, 3});
  return map;
}

std::vector<MapFeedback> feedbacks(const RoadNetwork& network, const std::vector<VehicleFix>& fixes,
                                   const FeedbackParameters& parameters = {}) {
  Matcher matcher(network, rules(), {});
  Feedback feedback(network, parameters);
  std::vector<MapFeedback> all;
  all.reserve(fixes.size());
  for (const VehicleFix& fix : fixes) all.push_back(feedback.decide(matcher.add(fix), fix));
  return all;
}

std::set<FeedbackReason> reasons(const std::vector<MapFeedback>& all) {
  std::set<FeedbackReason> found;
  for (const MapFeedback& f : all) found.insert(f.reason);
  return found;
}

std::vector<MapFeedback> fed(const std::vector<MapFeedback>& all) {
  std::vector<MapFeedback> found;
  for (const MapFeedback& f : all)
    if (f.position || f.azimuth) found.push_back(f);
  return found;
}

TEST(Feedback, OfAStraightRoadIsItsLineEveryTenMetres) {
  const RoadNetwork network = tee().network();
  FeedbackParameters parameters;
  parameters.lane_share = 0.0;
  const auto all = feedbacks(network, drive({{20, 0}, {520, 0}}, 10.0, 10.0, 1.5), parameters);
  const auto lines = fed(all);
  ASSERT_GT(lines.size(), 40u);
  ASSERT_LT(lines.size(), 50u);
  for (const MapFeedback& f : lines) {
    EXPECT_TRUE(f.position);
    EXPECT_NEAR(f.cross_track, 1.5, 0.05);  // to the right
    EXPECT_NEAR(f.link_azimuth, radians(90.0), 1e-3);
    EXPECT_NEAR(network.to_local(f.point).y(), network.to_local(SmallMap::place(300, 0)).y(), 0.05);
    EXPECT_FALSE(f.reset);
  }
  EXPECT_GT(lines.front().cross_sigma, lines.back().cross_sigma);  // the ramp
  EXPECT_TRUE(lines.front().new_road);
  EXPECT_FALSE(lines.back().new_road);
  EXPECT_GT(std::count_if(lines.begin(), lines.end(), [](const auto& f) { return f.azimuth; }), 15);
}

// A line for both directions is the middle of the road; vehicles drive beside it.
TEST(Feedback, OnARoadForBothDirectionsItIsToTheRight) {
  const RoadNetwork network = tee().network();
  const double middle = network.to_local(SmallMap::place(300, 0)).y();
  const double lane = 0.4 * 0.5 * half_width(network.road_at(0));
  ASSERT_GT(lane, 0.4);
  const auto off = [&](const std::vector<VehicleFix>& fixes, const FeedbackParameters& parameters) {
    const auto lines = fed(feedbacks(network, fixes, parameters));
    EXPECT_GT(lines.size(), 20u);
    return lines.empty() ? 0.0 : network.to_local(lines.back().point).y() - middle;
  };
  const auto eastward = drive({{20, 0}, {520, 0}}, 10.0, 10.0, 1.5);
  const auto westward = drive({{580, 0}, {80, 0}}, 10.0, 10.0, 1.5);
  FeedbackParameters parameters;
  EXPECT_NEAR(off(eastward, parameters), -lane, 0.02);
  EXPECT_NEAR(off(westward, parameters), lane, 0.02);
  EXPECT_NEAR(fed(feedbacks(network, eastward)).back().cross_track, 1.5 - lane, 0.05);
  const RoadNetwork left(tee().network().data(), RoadSide::left);
  EXPECT_NEAR(left.to_local(fed(feedbacks(left, eastward, parameters)).back().point).y() - middle,
              lane, 0.02);
  parameters = {};
  parameters.hard_reset = true;  // onto the line
  EXPECT_NEAR(off(eastward, parameters), 0.0, 0.02);
}

TEST(Feedback, OfAOneWayLineItIsTheLine) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 600, 0);
  map.way(10, {1, 2}, maploop::testing::one_way());
  const RoadNetwork network = map.network();
  const auto lines = fed(feedbacks(network, drive({{20, 0}, {520, 0}}, 10.0, 10.0, 1.5)));
  ASSERT_FALSE(lines.empty());
  EXPECT_NEAR(lines.back().cross_track, 1.5, 0.05);
}

TEST(Feedback, NothingBeforeALinkIsEstablishedNorNearItsJunctions) {
  const RoadNetwork network = tee().network();
  const auto all = feedbacks(network, drive({{20, 0}, {598, 0}}, 10.0, 10.0));
  EXPECT_EQ(all.front().reason, FeedbackReason::not_established);
  EXPECT_EQ(all.back().reason, FeedbackReason::near_junction);
}

TEST(Feedback, BehindATurnTheRoadIsAnotherOne) {
  const RoadNetwork network = tee().network();
  const auto all = feedbacks(network, drive({{300, 0}, {600, 0}, {600, 250}}, 8.0, 10.0));
  const auto lines = fed(all);
  ASSERT_FALSE(lines.empty());
  int roads = 0;
  for (const MapFeedback& f : lines) roads += f.new_road ? 1 : 0;
  EXPECT_EQ(roads, 2);
  EXPECT_NEAR(lines.back().link_azimuth, 0.0, 1e-3);
  EXPECT_TRUE(reasons(all).contains(FeedbackReason::link_changed));
}

TEST(Feedback, NothingWhereTheAzimuthDiffersOrTheVehicleCrawls) {
  const RoadNetwork network = tee().network();
  auto fixes = drive({{20, 0}, {400, 0}}, 10.0, 10.0);
  for (VehicleFix& fix : fixes) fix.azimuth += radians(20.0);
  EXPECT_TRUE(fed(feedbacks(network, fixes)).empty());
  fixes = drive({{20, 0}, {100, 0}}, 2.0, 10.0);
  const auto crawling = feedbacks(network, fixes);
  EXPECT_TRUE(fed(crawling).empty());
  EXPECT_TRUE(reasons(crawling).contains(FeedbackReason::too_slow));
}

TEST(Feedback, NothingWhileTurningOtherwiseThanTheRoad) {
  const RoadNetwork network = tee().network();
  auto fixes = drive({{20, 0}, {400, 0}}, 10.0, 10.0);
  // The vehicle turns 8 degrees to the left and back, as when it passes a parked car.
  for (std::size_t i = 200; i < 210; ++i) fixes[i].azimuth -= radians(8.0);
  const auto all = feedbacks(network, fixes);
  EXPECT_EQ(all[205].reason, FeedbackReason::turning);
  EXPECT_EQ(all[215].reason, FeedbackReason::turning);
  EXPECT_NE(all[260].reason, FeedbackReason::turning);
}

TEST(Feedback, NothingBetweenTwoRoadsThatMayBothBeTheOne) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 600, 0).node(3, 0, 10).node(4, 600, 10);
  map.way(10, {1, 2}).way(20, {3, 4});
  auto fixes = drive({{20, 4}, {520, 4}}, 10.0, 10.0);
  for (VehicleFix& fix : fixes) fix.covariance = 36.0 * Eigen::Matrix2d::Identity();
  const auto all = feedbacks(map.network(), fixes);
  for (const MapFeedback& f : all) EXPECT_FALSE(f.position);
}

TEST(Feedback, NothingOffTheRoad) {
  const RoadNetwork network = tee().network();
  const auto all = feedbacks(network, drive({{20, -120}, {400, -120}}, 10.0, 10.0));
  EXPECT_TRUE(fed(all).empty());
  EXPECT_TRUE(reasons(all).contains(FeedbackReason::off_road));
}

TEST(Feedback, OffsetsThatContradictTheFixesStopIt) {
  const RoadNetwork network = tee().network();
  const auto all = feedbacks(network, drive({{20, 0}, {590, 0}}, 10.0, 10.0, 8.0));
  EXPECT_TRUE(reasons(all).contains(FeedbackReason::inconsistent));
}

TEST(Feedback, AHardResetIsEveryFixThatPasses) {
  const RoadNetwork network = tee().network();
  FeedbackParameters parameters;
  parameters.hard_reset = true;
  const auto lines = fed(feedbacks(network, drive({{20, 0}, {520, 0}}, 10.0, 10.0), parameters));
  EXPECT_GT(lines.size(), 400u);
  for (const MapFeedback& f : lines) EXPECT_TRUE(f.reset && f.position && f.azimuth);
}

TEST(Feedback, GoesOnFromAnArchiveWithTheSameBits) {
  const RoadNetwork network = tee().network();
  const auto fixes = drive({{20, 0}, {600, 0}, {600, 200}}, 10.0, 10.0, 1.0);
  Matcher matcher(network, rules(), {});
  Feedback whole(network, {});
  Feedback resumed(network, {});
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const MatchResult& match = matcher.add(fixes[i]);
    const MapFeedback a = whole.decide(match, fixes[i]);
    if (i < 300) {
      if (i == 299) maploop::testing::load(maploop::testing::saved(whole), resumed);
      continue;
    }
    const MapFeedback b = resumed.decide(match, fixes[i]);
    EXPECT_EQ(maploop::testing::saved(a), maploop::testing::saved(b));
  }
}

TEST(Feedback, TellsBridgesTunnelsAndOtherLevels) {
  for (const char* where : {"ground", "bridge", "tunnel", "layer"}) {
    Road road;
    road.bridge = where == std::string_view("bridge");
    road.tunnel = where == std::string_view("tunnel");
    road.layer = where == std::string_view("layer") ? 1 : 0;
    SmallMap map;
    map.node(1, 0, 0).node(2, 600, 0).way(10, {1, 2}, road);
    const auto all = feedbacks(map.network(), drive({{20, 0}, {520, 0}}, 10.0, 10.0, 1.5));
    EXPECT_EQ(all.back().off_ground, where != std::string_view("ground")) << where;
  }
}

TEST(Feedback, AllocatesNothing) {
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const RoadNetwork network = tee().network();
  const auto fixes = drive({{20, 0}, {600, 0}, {600, 200}}, 10.0, 10.0, 1.0);
  Matcher matcher(network, rules(), {});
  Feedback feedback(network, {});
  const long before = maploop::testing::thread_allocations();
  for (const VehicleFix& fix : fixes) feedback.decide(matcher.add(fix), fix);
  EXPECT_EQ(maploop::testing::thread_allocations(), before);
}

}  // namespace
}  // namespace maploop::mapmatch
