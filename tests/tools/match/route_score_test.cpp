// Tests the score of a route against the links really driven.
#include "tools/match/route_score.h"

#include <gtest/gtest.h>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;

// Streets of 100 m in a row from node 1 to node 6, ways 10 to 14, and one of 50 m to the
// north from each node between.
mapmatch::RoadNetwork streets() {
  SmallMap map;
  map.node(1, 0, 0).node(2, 100, 0).node(3, 200, 0).node(4, 300, 0).node(5, 400, 0);
  map.node(6, 500, 0).node(7, 200, 50).node(8, 400, 50);
  map.way(10, {1, 2}).way(11, {2, 3}).way(12, {3, 4}).way(13, {4, 5}).way(14, {5, 6});
  map.node(9, 100, 50).node(10, 300, 50).way(22, {2, 9}).way(23, {4, 10});
  return map.way(20, {3, 7}).way(21, {5, 8}).network();
}

class RouteScoreTest : public ::testing::Test {
 protected:
  // Adds a fix that was on the segment from a to b, and was matched `along` metres on that from c
  // to d.
  void fix(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d, double along) {
    labels_[rows_.size()] = {0, a, b, true};
    const auto link = links_.find(c, d);
    ASSERT_TRUE(link);
    mapmatch::MatchResult result;
    result.on_road = true;
    result.link = *link;
    result.along = along;
    result.point = network_.at(*link, along);
    result.stamp = Time(std::chrono::seconds(5 * (rows_.size() + 1)));
    mapmatch::VehicleFix fix;
    fix.stamp = result.stamp;
    track_.fixes.push_back(fix);
    track_.results.push_back(result);
    rows_.push_back(rows_.size());
  }

  RouteScore score() {
    links_.look_up(labels_);
    return score_route(track_, rows_, labels_, network_);
  }

  mapmatch::RoadNetwork network_ = streets();
  SegmentLinks links_{network_};
  MatchedTrack track_;
  std::vector<std::size_t> rows_;
  Labels labels_;
};

TEST_F(RouteScoreTest, OfTheLinksDrivenIsAllRight) {
  fix(1, 2, 1, 2, 50.0);
  fix(2, 3, 2, 3, 50.0);
  fix(4, 5, 4, 5, 50.0);  // no fix is on the street before
  fix(5, 6, 5, 6, 50.0);
  const RouteScore route = score();
  EXPECT_NEAR(route.driven, 300.0, 0.1) << "without the first and the last street";
  EXPECT_NEAR(route.right_share(), 1.0, 1e-6);
  EXPECT_NEAR(route.too_much, 0.0, 1e-6);
}

TEST_F(RouteScoreTest, AStreetNotDrivenIsTooMuch) {
  fix(1, 2, 1, 2, 50.0);
  fix(2, 3, 2, 3, 50.0);
  fix(3, 4, 3, 7, 40.0);
  fix(5, 6, 5, 6, 50.0);
  EXPECT_NEAR(score().too_much, 100.0, 0.1) << "to its end and back";
}

TEST_F(RouteScoreTest, WhatTheRouteLeavesOutIsNotRight) {
  fix(1, 2, 1, 2, 50.0);
  fix(2, 3, 2, 3, 50.0);
  fix(3, 4, 3, 4, 50.0);
  fix(4, 5, 4, 5, 50.0);
  fix(5, 6, 5, 6, 50.0);
  track_.results[2].on_road = track_.results[3].on_road = false;
  const RouteScore route = score();
  EXPECT_NEAR(route.driven, 300.0, 0.1);
  EXPECT_NEAR(route.right, 50.0, 0.1) << "until the last fix on a road";
  EXPECT_NEAR(route.too_much, 0.0, 0.1);
}

TEST_F(RouteScoreTest, AMatchAheadOfTheEndOfTheDriveIsNotAWholeLinkTooMuch) {
  fix(1, 2, 1, 2, 50.0);
  fix(2, 3, 2, 3, 50.0);
  fix(3, 4, 3, 4, 90.0);
  fix(3, 4, 4, 5, 1.0);
  const RouteScore route = score();
  EXPECT_NEAR(route.driven, 100.0, 0.1);
  EXPECT_NEAR(route.too_much, 1.0, 0.1);
}

TEST_F(RouteScoreTest, OfTooFewLinksHasNoLength) {
  fix(1, 2, 1, 2, 50.0);
  fix(2, 3, 2, 3, 50.0);
  EXPECT_EQ(score().driven, 0.0);
}

}  // namespace
}  // namespace maploop::match
