// These tests check on hand-made maps which contradictions of a drive are found, and that a drive
// that keeps to the map contradicts nothing.
#include "mapmatch/doubt_collector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
using maploop::testing::one_way;
using maploop::testing::rules;
using maploop::testing::SmallMap;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Returns what is likelier than not.
std::vector<MapDoubt> doubts(const RoadNetwork& network, const std::vector<VehicleFix>& fixes) {
  Matcher matcher(network, rules(), {});
  DoubtCollector collector(network, {});
  std::vector<MapDoubt> all;
  const auto take = [&](std::span<const MapDoubt> some) {
    for (const MapDoubt& doubt : some)
      if (doubt.probability > 0.5) all.push_back(doubt);
  };
  for (const VehicleFix& fix : fixes) take(collector.add(matcher.add(fix), fix));
  take(collector.finish());
  return all;
}

// A street of 1 km from west to east (way 10), and one across its middle to the north (way 20).
SmallMap side_street(const Road& across = {}) {
  SmallMap map;
  map.node(1, -500, 0).node(2, 0, 0).node(3, 500, 0).node(4, 0, 500);
  map.way(10, {1, 2, 3}).way(20, {2, 4}, across);
  return map;
}

double from_place(const Geodetic& a, const Geodetic& b) {
  return LocalFrame(b).to_enu(a).head<2>().norm();
}

TEST(DoubtCollector, FindsNothingOnADriveThatKeepsToTheMap) {
  EXPECT_THAT(
      doubts(side_street().network(), drive({{-490, 0}, {0, 0}, {0, 490}}, 10.0, 10.0, 1.5)),
      IsEmpty());
}

TEST(DoubtCollector, WhereTheReceiverJumpsNoRoadIsMissing) {
  auto fixes = drive({{-490, 0}, {490, 0}}, 10.0, 1.0);
  for (std::size_t i = 40; i < 52; ++i) fixes[i].position.latitude += radians(0.004);  // 440 m
  fixes[70].position = {};
  EXPECT_THAT(doubts(side_street().network(), fixes), IsEmpty());
}

TEST(DoubtCollector, FindsTheRoadThatTheMapLacksWithItsTrackAndItsNeighbours) {
  const SmallMap map = SmallMap()
                           .node(1, -500, 0)
                           .node(2, 0, 0)
                           .node(3, 500, 0)
                           .node(5, 0, 900)
                           .node(6, 500, 900)
                           .way(10, {1, 2, 3})
                           .way(30, {5, 6});
  const auto found =
      doubts(map.network(), drive({{-490, 0}, {0, 0}, {0, 900}, {490, 900}}, 10.0, 10.0));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, DoubtKind::missing_road);
  EXPECT_EQ(found[0].from.way_id, 10);
  EXPECT_EQ(found[0].to.way_id, 30);
  EXPECT_NEAR(found[0].length, 900.0, 100.0);
  ASSERT_GT(found[0].track_count, 20U);
  EXPECT_LT(from_place(found[0].track[0], SmallMap::place(0, 0)), 60.0);
  EXPECT_LT(from_place(found[0].track[found[0].track_count - 1], SmallMap::place(0, 900)), 60.0);
}

TEST(DoubtCollector, FindsAOneWayStreetDrivenAgainstItsDirection) {
  const auto found =
      doubts(side_street(one_way()).network(), drive({{0, 490}, {0, 0}, {490, 0}}, 10.0, 10.0));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, DoubtKind::wrong_direction);
  EXPECT_EQ(found[0].from.way_id, 20);
  EXPECT_EQ(found[0].from.node_a, 4);
  EXPECT_EQ(found[0].from.node_b, 2);
  EXPECT_NEAR(found[0].length, 480.0, 60.0);
  EXPECT_LT(to_seconds(found[0].begin - Time{}), to_seconds(found[0].stamp - Time{}));
}

TEST(DoubtCollector, FindsATurnThatTheMapForbids) {
  const auto network = side_street().ban(10, 2, 20).network();
  const auto found = doubts(network, drive({{-490, 0}, {0, 0}, {0, 490}}, 10.0, 10.0));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, DoubtKind::forbidden_turn);
  EXPECT_EQ(found[0].from.way_id, 10);
  EXPECT_EQ(found[0].to.way_id, 20);
}

TEST(DoubtCollector, FindsARoadThatWasDrivenBesideItsLine) {
  auto fixes = drive({{-490, 0}, {490, 0}}, 10.0, 10.0, 9.0);
  for (VehicleFix& fix : fixes) fix.covariance = Eigen::Matrix2d::Identity();
  const auto found = doubts(side_street().network(), fixes);
  ASSERT_THAT(found, ::testing::Not(IsEmpty()));
  EXPECT_EQ(found[0].kind, DoubtKind::shifted_road);
  EXPECT_NEAR(found[0].offset, 9.0, 0.5);
  EXPECT_NEAR(found[0].offset_sigma, 1.0, 0.01);
  for (VehicleFix& fix : fixes) fix.covariance = 100.0 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(doubts(side_street().network(), fixes), IsEmpty())
      << "of positions that are no better";
}

TEST(DoubtCollector, TheProbabilityOfAShiftGrowsWithTheOffsetAndFallsWithItsSigma) {
  EXPECT_LT(probability_of_shift(0.0, 1.0, 3.0), 0.02);
  EXPECT_LT(probability_of_shift(3.0, 1.0, 3.0), 0.1);
  EXPECT_GT(probability_of_shift(10.0, 1.0, 3.0), 0.99);
  EXPECT_LT(probability_of_shift(10.0, 10.0, 3.0), 0.05);
  EXPECT_EQ(probability_of_shift(-10.0, 2.0, 3.0), probability_of_shift(10.0, 2.0, 3.0));
}

TEST(DoubtCollector, AWayBackwardsIsNotDrivenAgainstItsDirection) {
  auto fixes = drive({{0, 490}, {0, 10}}, 2.0, 10.0);
  for (VehicleFix& fix : fixes) {
    fix.speed = -fix.speed;
    fix.azimuth = wrap_angle(fix.azimuth + radians(180.0));
  }
  EXPECT_THAT(doubts(side_street(one_way()).network(), fixes), IsEmpty());
}

TEST(DoubtCollector, APauseEndsTheDoubtThatIsOpen) {
  auto fixes = drive({{0, 490}, {0, 250}}, 10.0, 10.0);
  const auto after = drive({{0, 250}, {0, 10}}, 10.0, 10.0);
  for (VehicleFix fix : after) {
    fix.stamp += from_seconds(1000.0);
    fixes.push_back(fix);
  }
  EXPECT_THAT(doubts(side_street(one_way()).network(), fixes), SizeIs(2));
}

TEST(DoubtCollector, WithoutASpeedTheWayIsThatOfThePositions) {
  auto fixes = drive({{0, 490}, {0, 0}, {490, 0}}, 10.0, 10.0);
  for (VehicleFix& fix : fixes) fix.speed = unknown;
  const auto found = doubts(side_street(one_way()).network(), fixes);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].length, 480.0, 60.0);
}

TEST(DoubtCollector, ATurnNamesTheWaysAtItsJunction) {
  SmallMap map;
  map.node(1, -500, 0).node(7, -250, 0).node(2, 0, 0).node(3, 500, 0).node(4, 0, 500);
  map.way(11, {1, 7}).way(10, {7, 2}).way(12, {2, 3}).way(20, {2, 4}).ban(10, 2, 20);
  const auto found = doubts(map.network(), drive({{-490, 0}, {0, 0}, {0, 490}}, 10.0, 10.0));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, DoubtKind::forbidden_turn);
  EXPECT_EQ(found[0].from.way_id, 10);
  EXPECT_EQ(found[0].to.node_a, 2);
}

TEST(DoubtCollector, OutsideOfTheMapNothingIsMissing) {
  const auto found =
      doubts(side_street().network(), drive({{-490, 0}, {500, 0}, {9000, 0}}, 20.0, 10.0));
  for (const MapDoubt& doubt : found) EXPECT_LT(doubt.length, 150.0);
}

TEST(DoubtCollector, ASpeedThatIsUnknownOnceAddsNoWay) {
  auto fixes = drive({{0, 490}, {0, 0}, {490, 0}}, 10.0, 10.0);
  fixes[200].speed = unknown;
  const auto found = doubts(side_street(one_way()).network(), fixes);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].length, 480.0, 60.0);
}

TEST(DoubtCollector, GoesOnAsLongAsTheMatcherDoes) {
  const auto network = side_street(one_way()).network();
  const auto fixes = drive({{0, 490}, {0, 0}, {490, 0}}, 10.0, 1.0 / 15.0);
  for (const double max_gap : {10.0, 20.0}) {
    MatchParameters parameters;
    parameters.max_gap = max_gap;
    Matcher matcher(network, rules(), parameters);
    DoubtCollector collector(network, parameters);
    std::size_t found = 0;
    for (const VehicleFix& fix : fixes) found += collector.add(matcher.add(fix), fix).size();
    EXPECT_EQ(found > 0, max_gap > 15.0) << max_gap;
  }
}

TEST(DoubtCollector, RefusesArchivesThatAreBroken) {
  const RoadNetwork network = side_street(one_way()).network();
  Matcher matcher(network, rules(), {});
  DoubtCollector collector(network, {});
  for (const VehicleFix& fix : drive({{0, 490}, {0, 100}}, 10.0, 10.0))
    collector.add(matcher.add(fix), fix);
  const auto archive = maploop::testing::saved(collector);
  maploop::testing::expect_refuses_broken(archive, collector);
  const RoadNetwork empty{NetworkData{}};
  DoubtCollector other(empty, {});
  EXPECT_THAT(maploop::testing::refusal(archive, other), ::testing::HasSubstr("does not exist"));
}

TEST(DoubtCollector, GoesOnFromAnArchiveWithTheSameBits) {
  const RoadNetwork network = side_street(one_way()).network();
  const auto fixes = drive({{0, 490}, {0, 0}, {490, 0}, {490, 500}}, 10.0, 10.0);
  Matcher matcher(network, rules(), {});
  DoubtCollector whole(network, {});
  DoubtCollector resumed(network, {});
  std::size_t found = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const MatchResult& match = matcher.add(fixes[i]);
    const auto a = whole.add(match, fixes[i]);
    if (i < 300) {
      if (i == 299) maploop::testing::load(maploop::testing::saved(whole), resumed);
      continue;
    }
    const auto b = resumed.add(match, fixes[i]);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t j = 0; j < a.size(); ++j)
      EXPECT_EQ(maploop::testing::saved(a[j]), maploop::testing::saved(b[j]));
    found += a.size();
  }
  EXPECT_GT(found, 0U);
}

TEST(DoubtCollector, AllocatesNothing) {
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const RoadNetwork network = side_street(one_way()).network();
  const auto fixes = drive({{0, 490}, {0, 0}, {490, 0}, {490, 500}}, 10.0, 10.0);
  Matcher matcher(network, rules(), {});
  DoubtCollector collector(network, {});
  const long before = maploop::testing::thread_allocations();
  for (const VehicleFix& fix : fixes) collector.add(matcher.add(fix), fix);
  EXPECT_EQ(maploop::testing::thread_allocations(), before);
}

TEST(DriveStretch, KeepsTheWholeOfALongTrackAndItsCorners) {
  DriveStretch stretch{Time{}};
  for (int i = 0; i < 10'000; ++i) {
    const double along = 1e-6 * i;  // to the north, then to the east
    stretch.add({std::min(along, 5e-3), std::max(along - 5e-3, 0.0), 0.0}, 1.0,
                i < 5'000 ? 1.0 : 0.5);
  }
  MapDoubt doubt;
  stretch.describe(doubt);
  EXPECT_NEAR(stretch.probability(), 0.75, 1e-9);
  EXPECT_EQ(doubt.length, 10'000.0);
  ASSERT_EQ(doubt.track_count, MapDoubt::max_points);
  EXPECT_EQ(doubt.track[0].latitude, 0.0);
  EXPECT_GT(doubt.track[doubt.track_count - 1].longitude, 4.98e-3);
  double from_corner = 1.0;
  for (const Geodetic& p : doubt.track)
    from_corner = std::min(from_corner, std::hypot(p.latitude - 5e-3, p.longitude));
  EXPECT_LT(from_corner, 1.1e-5);
}

}  // namespace
}  // namespace maploop::mapmatch
