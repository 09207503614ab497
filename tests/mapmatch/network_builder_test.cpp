#include "mapmatch/network_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/mapmatch/small_map.h"

namespace maploop::mapmatch {
namespace {

using testing::one_way;
using testing::SmallMap;

std::set<std::int64_t> ways_of(const RoadNetwork& network, std::uint32_t link) {
  std::set<std::int64_t> ways;
  const Link& l = network.link(link);
  for (std::uint32_t v = l.first_vertex; v + 1 < l.first_vertex + l.vertex_count; ++v)
    ways.insert(network.road_at(v).way_id);
  return ways;
}

TEST(NetworkBuilder, ALinkGoesOnWhereOneWayBecomesAnother) {
  const RoadNetwork network = SmallMap()
                                  .node(1, 0, 0)
                                  .node(2, 100, 0)
                                  .node(3, 200, 0)
                                  .way(10, {1, 2})
                                  .way(11, {3, 2})
                                  .network();
  ASSERT_EQ(network.size(), 1u);
  EXPECT_NEAR(network.link(0).length, 200.0, 0.01);
  EXPECT_EQ(ways_of(network, 0), (std::set<std::int64_t>{10, 11}));
  EXPECT_EQ(network.data().junctions.size(), 2u);
}

TEST(NetworkBuilder, RoadsThatMeetInTheMiddleOfAWayCutIt) {
  const RoadNetwork network = SmallMap()
                                  .node(1, 0, 0)
                                  .node(2, 100, 0)
                                  .node(3, 200, 0)
                                  .node(4, 100, 50)
                                  .way(10, {1, 2, 3})
                                  .way(11, {2, 4})
                                  .network();
  EXPECT_EQ(network.size(), 3u);
  EXPECT_EQ(network.data().junctions.size(), 4u);
}

TEST(NetworkBuilder, ALinkEndsWhereAOneWayStreetBegins) {
  const RoadNetwork network = SmallMap()
                                  .node(1, 0, 0)
                                  .node(2, 100, 0)
                                  .node(3, 200, 0)
                                  .way(10, {1, 2})
                                  .way(11, {3, 2}, one_way())
                                  .network();
  ASSERT_EQ(network.size(), 2u);
  EXPECT_TRUE(network.allowed({0, true}));
  EXPECT_TRUE(network.allowed({0, false}));
  const auto shape = network.shape(1);
  const bool drawn_from_2 = shape.front().node_id == 2;
  EXPECT_EQ(network.allowed({1, true}), !drawn_from_2) << "driven from 3 to 2 only";
  EXPECT_EQ(network.allowed({1, false}), drawn_from_2);
}

TEST(NetworkBuilder, ARingThatMeetsNothingIsALink) {
  const RoadNetwork network =
      SmallMap().node(1, 0, 0).node(2, 50, 0).node(3, 50, 50).way(10, {1, 2, 3, 1}).network();
  ASSERT_EQ(network.size(), 1u);
  EXPECT_EQ(network.link(0).start_junction, network.link(0).end_junction);
}

TEST(NetworkBuilder, AWayIsCutWhereANodeIsMissing) {
  const RoadNetwork network = SmallMap()
                                  .node(1, 0, 0)
                                  .node(2, 50, 0)
                                  .node(4, 150, 0)
                                  .node(5, 200, 0)
                                  .way(10, {1, 2, 3, 4, 5})
                                  .network();
  EXPECT_EQ(network.size(), 2u);
  EXPECT_THAT(network.data().warnings, ::testing::ElementsAre(::testing::HasSubstr("1 nodes")));
}

TEST(NetworkBuilder, ANodeNamedTwiceInARowAndTwoNodesAtOnePlaceAreHarmless) {
  const RoadNetwork network = SmallMap()
                                  .node(1, 0, 0)
                                  .node(2, 50, 0)
                                  .node(3, 50, 0)
                                  .node(4, 90, 0)
                                  .way(10, {1, 1, 2, 3, 4})
                                  .network();
  ASSERT_EQ(network.size(), 1u);
  for (double s = -10.0; s < 100.0; s += 0.0005 + s * s * 1e-3)
    EXPECT_NEAR(network.at({0, true}, s).direction.norm(), 1.0, 1e-9) << s;
}

// Returns a way that passes one node repeatedly and has two exits there each time.
SmallMap flower(int petals) {
  SmallMap map;
  map.node(1, 0, 0);
  std::vector<std::int64_t> nodes{1};
  for (int i = 0; i < petals; ++i) {
    map.node(2 + i, 100.0 + i, 50.0);
    nodes.push_back(2 + i);
    nodes.push_back(1);
  }
  return map.way(10, nodes);
}

TEST(NetworkBuilder, RestrictionsThatSayTheSameBanATurnOnce) {
  SmallMap map = flower(5);
  map.ban(10, 1, 10);
  const std::size_t once = map.network().data().banned.size();
  EXPECT_EQ(once, 90u) << "each of ten exits to the nine others";
  for (int i = 0; i < 100; ++i) map.ban(10, 1, 10);
  EXPECT_EQ(map.network().data().banned.size(), once);
}

TEST(NetworkBuilder, RestrictionsWhereMoreRoadsMeetThanAnywhereAreLeftOut) {
  SmallMap map = flower(100);
  map.ban(10, 1, 10);
  const RoadNetwork network = map.network();
  EXPECT_TRUE(network.data().banned.empty());
  EXPECT_THAT(network.data().warnings,
              ::testing::Contains(::testing::HasSubstr("1 turn restrictions are left out where")));
}

TEST(NetworkBuilder, NoTurnAndOnlyTurnAreBannedTurns) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 100, 0).node(3, 200, 0).node(4, 100, 80).node(5, 100, -80);
  map.way(10, {1, 2}).way(11, {2, 3}).way(12, {2, 4}).way(13, {2, 5});
  map.ban(10, 2, 12).ban(11, 2, 10, true).ban(99, 2, 10);
  const RoadNetwork network = map.network();
  const auto leaving = [&](std::int64_t way) {
    for (std::uint32_t j = 0; j < network.data().junctions.size(); ++j)
      for (const DirectedLink d : network.exits(j))
        if (network.data().junctions[j].node_id == 2 && ways_of(network, d.link).contains(way))
          return d;
    return DirectedLink{};
  };
  EXPECT_FALSE(network.allowed_turn(leaving(10).reversed(), leaving(12)));
  EXPECT_TRUE(network.allowed_turn(leaving(10).reversed(), leaving(11)));
  EXPECT_TRUE(network.allowed_turn(leaving(12).reversed(), leaving(10))) << "the other way round";
  EXPECT_TRUE(network.allowed_turn(leaving(11).reversed(), leaving(10)));
  EXPECT_FALSE(network.allowed_turn(leaving(11).reversed(), leaving(13)));
  EXPECT_THAT(network.data().warnings, ::testing::Contains(::testing::HasSubstr("1 turn restr")));
}

TEST(NetworkBuilder, PlacesAlongALinkInBothDirections) {
  const RoadNetwork network =
      SmallMap().node(1, 0, 0).node(2, 100, 0).node(3, 100, 100).way(10, {1, 2, 3}).network();
  const LinkPoint there = network.at({0, true}, 150.0);
  const LinkPoint back = network.at({0, false}, 50.0);
  EXPECT_LT((there.position - back.position).norm(), 1e-6);
  EXPECT_NEAR(there.azimuth(), 0.0, 1e-4);
  EXPECT_NEAR(std::abs(back.azimuth()), 3.14159, 1e-4);
  EXPECT_EQ(network.nodes({0, true}, there.vertex), (std::pair<std::int64_t, std::int64_t>{2, 3}));
  EXPECT_EQ(network.nodes({0, false}, back.vertex), (std::pair<std::int64_t, std::int64_t>{3, 2}));
}

TEST(NetworkBuilder, AnEmptyMapIsAnEmptyNetwork) {
  const RoadNetwork network(build_network({}));
  EXPECT_EQ(network.size(), 0u);
  int visited = 0;
  network.index().visit({-1e9, -1e9, 1e9, 1e9}, [&](const IndexedSegment&) { ++visited; });
  EXPECT_EQ(visited, 0);
}

TEST(NetworkBuilder, ContradictoryDataAreRefused) {
  NetworkData data = build_network(SmallMap().node(1, 0, 0).node(2, 9, 0).way(1, {1, 2}).extract());
  NetworkData broken = data;
  broken.links[0].vertex_count = 3;
  EXPECT_THROW(RoadNetwork{broken}, std::invalid_argument);
  broken = data;
  broken.exits[0].link = 7;
  EXPECT_THROW(RoadNetwork{broken}, std::invalid_argument);
  broken = data;
  broken.vertices[0].east = std::nan("");
  EXPECT_THROW(RoadNetwork{broken}, std::invalid_argument);
}

}  // namespace
}  // namespace maploop::mapmatch
