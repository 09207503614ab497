// These tests check one-way streets whose direction the map itself contradicts.
#include "mapmatch/one_way_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapmatch/matcher.h"
#include "tests/mapmatch/default_rule_bases.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::drive;
using maploop::testing::rules;
using maploop::testing::SmallMap;

Road carriageway(std::string name = "B 3") {
  Road road = maploop::testing::one_way();
  road.name = std::move(name);
  return road;
}

// Returns whether the map contradicts the direction of a way's first link.
bool doubted(const RoadNetwork& network, std::int64_t way) {
  for (std::uint32_t link = 0; link < network.size(); ++link) {
    if (network.road_at(network.link(link).first_vertex).way_id == way)
      return network.doubted(link);
  }
  ADD_FAILURE() << "the map has no way " << way;
  return false;
}

// The map is a road from west to east whose carriageways are 15 m apart: way 10 is the southern
// one, way 20 the northern one. Both begin and end at ways for both directions.
SmallMap divided_road(bool east_in_the_south, const Road& south, const Road& north) {
  SmallMap map;
  map.node(1, -300, 0).node(2, 300, 0).node(3, -300, 15).node(4, 300, 15);
  map.way(10, east_in_the_south ? std::vector<std::int64_t>{1, 2} : std::vector<std::int64_t>{2, 1},
          south);
  map.way(20, east_in_the_south ? std::vector<std::int64_t>{4, 3} : std::vector<std::int64_t>{3, 4},
          north);
  map.way(30, {1, 3}).way(40, {2, 4});
  return map;
}

TEST(OneWayCheck, AnOppositeCarriagewayBelongsOnTheSideOfTheOtherTraffic) {
  for (const bool east_in_the_south : {true, false}) {
    const NetworkData data =
        divided_road(east_in_the_south, carriageway(), carriageway()).network().data();
    const RoadNetwork by_map(data), right(data, RoadSide::right), left(data, RoadSide::left);
    EXPECT_EQ(by_map.left_hand_traffic(), !east_in_the_south);
    for (const std::int64_t way : {10, 20}) {
      EXPECT_FALSE(doubted(by_map, way));
      EXPECT_EQ(doubted(right, way), !east_in_the_south);
      EXPECT_EQ(doubted(left, way), east_in_the_south);
    }
  }
}

TEST(OneWayCheck, TwoRoadsBesideEachOtherAreNoCarriageways) {
  Road circle = carriageway();
  circle.roundabout = true;
  NetworkData other_name = divided_road(false, carriageway(), carriageway("B 10")).network().data();
  NetworkData circles = divided_road(false, circle, circle).network().data();
  NetworkData lanes = divided_road(false, carriageway(), carriageway()).network().data();
  NetworkData slip_road = lanes;
  for (Road& road : lanes.roads) road.road_class = RoadClass::service;
  slip_road.roads.front().road_class = RoadClass::primary_link;
  for (const NetworkData* data : {&other_name, &circles, &lanes, &slip_road}) {
    const RoadNetwork network(*data, RoadSide::right);
    EXPECT_EQ(network.one_way_checks().to_right, 0U);
    EXPECT_FALSE(doubted(network, 10) || doubted(network, 20));
  }
}

TEST(OneWayCheck, ACarriagewayKeepsItsNameOrHasOneInCommon) {
  for (const auto& [south, north] :
       {std::pair("B 3", "B 10; B 3"), std::pair("B 10;B 3", "B 3;A 8"), std::pair("", "")}) {
    const RoadNetwork network(
        divided_road(false, carriageway(south), carriageway(north)).network().data(),
        RoadSide::right);
    EXPECT_TRUE(doubted(network, 10) && doubted(network, 20)) << south << ", " << north;
  }
}

TEST(OneWayCheck, APartWithoutAnOppositeCarriagewayIsJudgedWithTheOthers) {
  SmallMap map = divided_road(false, carriageway(), carriageway());
  map.node(5, -500, 0).way(11, {1, 5}, carriageway()).node(6, -300, -100).way(31, {1, 6});
  const RoadNetwork network(map.network().data(), RoadSide::right);
  EXPECT_TRUE(doubted(network, 11));
}

TEST(OneWayCheck, AWayAgainstTheWaysBeforeAndBehindItIsDoubted) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 100, 0).node(3, 200, 0).node(4, 300, 0).node(5, 400, 0);
  map.node(6, 200, 100).node(7, 0, 100).node(8, 400, 100);
  map.way(10, {1, 2}, carriageway()).way(11, {4, 3, 2}, carriageway());
  map.way(12, {4, 5}, carriageway()).way(20, {3, 6}).way(21, {7, 1}).way(22, {8, 5});
  const RoadNetwork network = map.network();
  EXPECT_FALSE(doubted(network, 10)) << "reversing it would close its other end";
  EXPECT_TRUE(doubted(network, 11));
  EXPECT_FALSE(doubted(network, 12));
}

TEST(OneWayCheck, AnEndOfTheMapAndAStreetBothWaysAreNotDoubted) {
  const RoadNetwork end =
      SmallMap().node(1, 0, 0).node(2, 100, 0).way(10, {1, 2}, carriageway()).network();
  EXPECT_FALSE(doubted(end, 10));
  const RoadNetwork street =
      SmallMap().node(1, 0, 0).node(2, 100, 0).node(3, 200, 0).way(10, {1, 2, 3}).network();
  EXPECT_FALSE(doubted(street, 10));
}

// Each way is compared with those near it, which must not take hours for a map made to that end.
TEST(OneWayCheck, AHeapOfWaysIsLeftAlone) {
  SmallMap map;
  constexpr std::int64_t ways = 12'000;
  for (std::int64_t i = 1; i <= ways; ++i) {
    map.node(2 * i, 0, 1e-3 * static_cast<double>(i))
        .node(2 * i + 1, 10, 1e-3 * static_cast<double>(i));
    map.way(i, {2 * i, 2 * i + 1}, carriageway());
  }
  const RoadNetwork network = map.network();
  EXPECT_EQ(network.size(), static_cast<std::size_t>(ways));
  EXPECT_EQ(network.one_way_checks().to_left + network.one_way_checks().to_right, 0U);
}

TEST(OneWayCheck, ANodeOfManyWaysIsLeftAlone) {
  SmallMap map;
  map.node(1, 0, 0);
  constexpr std::int64_t ways = 20'000;
  for (std::int64_t i = 2; i <= ways; ++i) {
    const double angle = 1e-3 * static_cast<double>(i);
    map.node(i, 500.0 * std::cos(angle), 500.0 * std::sin(angle)).way(i, {i, 1}, carriageway());
  }
  const RoadNetwork network = map.network();
  EXPECT_FALSE(doubted(network, 2)) << "no traffic leaves the node, but too many ways meet there";
}

TEST(OneWayCheck, AContradictedDirectionIsDrivenBothWays) {
  const RoadNetwork network(divided_road(false, carriageway(), carriageway()).network().data(),
                            RoadSide::right);
  Matcher matcher(network, rules(), {});
  MatchResult last;
  for (const VehicleFix& fix : drive({{-250, 0}, {250, 0}}, 10.0, 1.0, 2.0))
    last = matcher.add(fix);
  ASSERT_TRUE(last.on_road);
  EXPECT_EQ(network.road_at(last.point.vertex).way_id, 10);
  EXPECT_FALSE(network.allowed(last.link)) << "it is driven against the map's direction";
  EXPECT_GT(last.probability, 0.9);
}

}  // namespace
}  // namespace maploop::mapmatch
