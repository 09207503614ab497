// Tests where doubts about the map are said, and that there are none without a cause.
#include "tools/match/map_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using web::Event;

class MapDoubts : public ::testing::Test {
 public:
  std::vector<Event> doubts(const mapmatch::RoadNetwork& network) const {
    mapmatch::Matcher matcher(network, rules, {});
    MatchedTrack track{drive, {}};
    for (const auto& fix : track.fixes) track.results.push_back(matcher.add(fix));
    return map_doubts(track, network);
  }

  static mapmatch::RoadNetwork straight(mapmatch::Road road = {}) {
    return SmallMap().node(1, -500, 0).node(2, 500, 0).way(10, {1, 2}, std::move(road)).network();
  }

  mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  Track drive = maploop::testing::drive({{-490, 0}, {490, 0}}, 10.0, 1.0);
};

TEST_F(MapDoubts, NothingIsSaidOfADriveOnTheRoad) {
  EXPECT_THAT(doubts(straight()), IsEmpty());
}

TEST_F(MapDoubts, AOneWayStreetDrivenTheOtherWayIsOneDoubtWithItsName) {
  mapmatch::Road road = maploop::testing::one_way();
  road.name = "High Street";
  drive = maploop::testing::drive({{490, 0}, {-490, 0}}, 10.0, 1.0);
  const auto found = doubts(straight(road));
  std::size_t against = 0;
  for (const Event& event : found) {
    if (event.text != "High Street, against its one-way direction") continue;
    ++against;
    EXPECT_EQ(event.level, Event::Level::warning);
    EXPECT_GT(event.to, event.from);
  }
  EXPECT_EQ(against, 1U);
}

TEST_F(MapDoubts, AFieldIsADoubtForAsLongAsTheVehicleIsOnIt) {
  drive = maploop::testing::drive({{-490, 0}, {490, 0}, {490, 900}}, 10.0, 1.0);
  const auto found = doubts(straight());
  ASSERT_THAT(found, ::testing::Not(IsEmpty()));
  EXPECT_THAT(found.back().text, StartsWith("on no road of the map: no road"));
  EXPECT_GT(found.back().from, 98.0);
  EXPECT_NEAR(found.back().to, 188.0, 1.0);
}

TEST_F(MapDoubts, AProbabilityThatFallsThoughThePositionIsGoodIsADoubtWithTheReason) {
  const auto twins = SmallMap()
                         .node(1, -500, 0)
                         .node(2, 0, 0)
                         .node(3, 500, 8)
                         .node(4, 500, -8)
                         .way(10, {1, 2})
                         .way(11, {2, 3})
                         .way(12, {2, 4})
                         .network();
  for (auto& fix : drive) fix.covariance = Eigen::Matrix2d::Identity();
  const auto found = doubts(twins);
  ASSERT_THAT(found, ::testing::Not(IsEmpty()));
  EXPECT_THAT(found[0].text, StartsWith("P fell although the position is good to 1.0 m: way 1"));
  EXPECT_THAT(found[0].text, HasSubstr("; not way 1"));
  EXPECT_EQ(found[0].level, Event::Level::note);
  for (auto& fix : drive) fix.covariance = 400.0 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(doubts(twins), IsEmpty()) << "of a position that cannot tell them apart";
}

TEST_F(MapDoubts, FixesThatWereNotUsedAreSaidWithTheReason) {
  drive.insert(drive.begin() + 50, 3, drive[49]);
  const auto found = doubts(straight());
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].text, "fixes not used: not later than the fix before");
  EXPECT_EQ(found[0].from, 49.0);
}

}  // namespace
}  // namespace maploop::match
