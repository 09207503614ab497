#include "mapmatch/lanes.h"

#include <gtest/gtest.h>

namespace maploop::mapmatch::lanes_test {
namespace {

Road two_way(int lanes, double width = 0.0) {
  Road road;
  road.road_class = RoadClass::primary;
  road.lanes = static_cast<std::uint8_t>(lanes);
  road.width = width;
  return road;
}

Road one_way(int lanes) {
  Road road = two_way(lanes);
  road.backward = false;
  return road;
}

TEST(Lanes, OfAOneWayRoadLieAboutItsLine) {
  const Lanes lanes = lanes_of(one_way(3), true, false);
  EXPECT_EQ(lanes.count, 3);
  EXPECT_DOUBLE_EQ(lanes.width, 3.25);
  EXPECT_DOUBLE_EQ(lanes.middle(1), -3.25);
  EXPECT_DOUBLE_EQ(lanes.middle(2), 0.0);
  EXPECT_DOUBLE_EQ(lanes.middle(3), 3.25);
  EXPECT_EQ(lanes_of(one_way(3), false, false).count, 0) << "nobody drives there";
  Road with_buses_against = one_way(3);
  with_buses_against.lanes_backward = 1;
  EXPECT_EQ(lanes_of(with_buses_against, true, false).count, 2);
  EXPECT_DOUBLE_EQ(lanes_of(with_buses_against, true, false).middle(1), 0.0);
  EXPECT_EQ(lanes_of(with_buses_against, false, false).count, 0);
  Road by_direction = one_way(0);
  by_direction.lanes_forward = 2;
  EXPECT_EQ(lanes_of(by_direction, true, false).count, 2);
}

TEST(Lanes, OfATwoWayRoadAreOnTheSideOfTheTraffic) {
  const Lanes right = lanes_of(two_way(4, 14.0), true, false);
  EXPECT_EQ(right.count, 2);
  EXPECT_DOUBLE_EQ(right.middle(1), 1.75);
  EXPECT_DOUBLE_EQ(right.middle(2), 5.25);
  const Lanes left = lanes_of(two_way(4, 14.0), true, true);
  EXPECT_DOUBLE_EQ(left.middle(1), -5.25);
  EXPECT_DOUBLE_EQ(left.middle(2), -1.75);
}

TEST(Lanes, MayDifferInNumberByDirection) {
  Road road = two_way(3, 9.0);
  EXPECT_EQ(lanes_of(road, true, false).count, 0) << "nothing tells where the third one is";
  road.lanes_forward = 2;
  const Lanes forward = lanes_of(road, true, false), backward = lanes_of(road, false, false);
  EXPECT_EQ(forward.count, 2);
  EXPECT_DOUBLE_EQ(forward.middle(1), 0.0);
  EXPECT_DOUBLE_EQ(forward.middle(2), 3.0);
  EXPECT_EQ(backward.count, 1);
  EXPECT_DOUBLE_EQ(backward.middle(1), 3.0);
  road.lanes_backward = 2;
  EXPECT_EQ(lanes_of(road, true, false).count, 0) << "2 + 2 are not 3";
  road.lanes = 0;
  EXPECT_EQ(lanes_of(road, true, false).count, 2);
  EXPECT_EQ(lanes_of(two_way(0), true, false).count, 0);
  EXPECT_EQ(lanes_of(two_way(1), true, false).count, 0) << "one lane for both directions";
}

TEST(Lanes, ThePositionHasTheProbabilityThatItsSigmaAllows) {
  const Lanes lanes = lanes_of(one_way(2), true, false);
  const LanePosition sure = lane_at(lanes, 1.9, 0.3);
  EXPECT_EQ(sure.lanes, 2);
  EXPECT_EQ(sure.lane, 2);
  EXPECT_NEAR(sure.probability, 1.0, 1e-6);
  EXPECT_NEAR(sure.offset, 0.275, 1e-9);
  EXPECT_NEAR(lane_at(lanes, 0.01, 1.0).probability, 0.508, 0.001);
  EXPECT_NEAR(lane_at(lanes, -1.625, 2.0).probability, 0.789, 0.001);
  EXPECT_EQ(lane_at(lanes, -1.0, 1e6).lane, 1);
  EXPECT_NEAR(lane_at(lanes, -1.0, 1e6).probability, 0.5, 1e-6);
  EXPECT_NEAR(lane_at(lanes, 1e5, 0.1).probability, 1.0, 1e-9) << "far off, and yet a number";
  EXPECT_EQ(lane_at(Lanes{}, 1.0, 1.0).lane, 0);
}

}  // namespace
}  // namespace maploop::mapmatch::lanes_test
