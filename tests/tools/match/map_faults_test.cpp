// Tests the errors made in maps, and what is counted on them, on a hand-made street.
#include "tools/match/map_faults.h"

#include <gtest/gtest.h>

#include "msgs/frames.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;

// Way 10 leads 300 m to the east, way 20 goes on from there.
mapmatch::MapExtract street() {
  SmallMap map;
  map.node(1, 0, 0).node(2, 300, 0).node(3, 600, 0);
  return map.way(10, {1, 2}).way(20, {2, 3}).extract();
}

Labels driven(std::int64_t from, std::int64_t to) {
  return {{0, {10, from, to, true, {}}}};
}

TEST(MapFaults, ADrivenWayMayBeDrivenOnlyTheOtherWay) {
  for (const bool eastwards : {true, false}) {
    const Labels labels = eastwards ? driven(1, 2) : driven(2, 1);
    const auto wrong = direction_wrong(street(), labels, 10);
    EXPECT_EQ(wrong.ways[0].road.forward, !eastwards);
    EXPECT_EQ(wrong.ways[0].road.backward, eastwards);
    EXPECT_TRUE(wrong.ways[1].road.forward && wrong.ways[1].road.backward);
  }
}

TEST(MapFaults, AWayDrivenBothWaysStaysAsItIs) {
  Labels labels = driven(1, 2);
  labels[1] = {10, 2, 1, true, {}};
  EXPECT_TRUE(direction_wrong(street(), labels, 10).ways[0].road.forward);
  EXPECT_EQ(with_opposite_carriageways(street(), labels, 12.0).ways.size(), 2u);
}

TEST(MapFaults, TheOppositeCarriagewayIsToTheLeftAndLeadsBack) {
  const auto divided = with_opposite_carriageways(street(), driven(2, 1), 12.0);
  ASSERT_EQ(divided.ways.size(), 3u);
  EXPECT_FALSE(divided.ways[0].road.forward);
  EXPECT_TRUE(divided.ways[0].road.backward);
  EXPECT_TRUE(divided.ways[2].road.forward);
  EXPECT_FALSE(divided.ways[2].road.backward);
  // The drive goes west, so its left is in the south.
  const std::int64_t beside = divided.ways[2].nodes[1];
  for (const mapmatch::MapNode& node : divided.nodes) {
    if (node.id == beside) {
      EXPECT_NEAR((node.latitude - 49.0) * 111200.0, -12.0, 0.1);
    }
  }
}

TEST(MapFaults, APointIsTurnedClockwise) {
  const auto network = mapmatch::build_network(street());
  const Eigen::Vector2d centre = network.vertices[0].position();
  const auto turned_by_90 = turned(network, centre, radians(90.0));
  const Eigen::Vector2d before = network.vertices[1].position() - centre;
  const Eigen::Vector2d after = turned_by_90.vertices[1].position() - centre;
  EXPECT_NEAR(after.x(), before.y(), 1e-9);
  EXPECT_NEAR(after.y(), -before.x(), 1e-9);
}

// One fix a second at 10 m/s: four on the right way, three sure on a wrong one, two unmatched.
TEST(MapFaults, CountsTheTimeSureOnAWrongWayAndTheDistanceUntilTheRightOne) {
  NoisyTrack noisy;
  noisy.track = maploop::testing::drive({{0, 0}, {100, 0}}, 10.0, 1.0);
  std::vector<MatchedFix> matched;
  Labels labels;
  for (std::size_t i = 0; i < noisy.track.size(); ++i) {
    noisy.rows.push_back(i);
    labels[i] = {10, 1, 2, true, {}};
    matched.push_back({10, 1, 2, 0.95, {}});
    if (i >= 4 && i < 7) matched[i].way_id = 20;
    if (i == 7 || i == 8) matched[i].way_id.reset();
  }
  const FaultScore score = score_fault(matched, noisy, labels, 0);
  EXPECT_NEAR(score.longest_sure_wrong, 2.0, 1e-6);
  EXPECT_NEAR(score.worst_at, 6.0, 1e-6);
  EXPECT_NEAR(score.recovery, 50.0, 1e-6);
  EXPECT_EQ(score.missing_fixes, 0u);
}

TEST(MapFaults, OnTheMissingWayNoRightLinkIsExpected) {
  NoisyTrack noisy;
  noisy.track = maploop::testing::drive({{0, 0}, {50, 0}}, 10.0, 1.0);
  Labels labels;
  std::vector<MatchedFix> matched;
  for (std::size_t i = 0; i < noisy.track.size(); ++i) {
    noisy.rows.push_back(i);
    labels[i] = {10, 1, 2, true, {}};
    matched.push_back({20, 2, 3, i == 0 ? 0.95 : 0.5, {}});
  }
  const FaultScore score = score_fault(matched, noisy, labels, 10);
  EXPECT_EQ(score.recovery, 0.0);
  EXPECT_EQ(score.missing_fixes, noisy.track.size());
  EXPECT_EQ(score.missing_said, noisy.track.size());
  EXPECT_EQ(score.missing_sure, 1u);
}

}  // namespace
}  // namespace maploop::match
