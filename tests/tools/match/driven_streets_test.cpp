// Tests the streets of a matched track, their order, times, lengths and probabilities.
#include "tools/match/driven_streets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::SizeIs;

mapmatch::Road road(const std::string& name) {
  mapmatch::Road r;
  r.name = name;
  r.road_class = mapmatch::RoadClass::residential;
  return r;
}

class DrivenStreets : public ::testing::Test {
 public:
  std::vector<DrivenStreet> streets(Track fixes) const {
    mapmatch::Matcher matcher(network, rules, {});
    MatchedTrack track{std::move(fixes), {}};
    for (const auto& fix : track.fixes) track.results.push_back(matcher.add(fix));
    return driven_streets(track, network);
  }

  // West Street, of two ways, and then a road without a name to the north.
  mapmatch::RoadNetwork network = SmallMap()
                                      .node(1, -400, 0)
                                      .node(2, -200, 0)
                                      .node(3, 0, 0)
                                      .node(4, 0, 300)
                                      .node(5, 300, 0)
                                      .way(10, {1, 2}, road("West Street"))
                                      .way(11, {2, 3}, road("West Street"))
                                      .way(12, {3, 4}, road(""))
                                      .way(13, {3, 5}, road("East Street"))
                                      .network();
  mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  Track drive = maploop::testing::drive({{-390, 0}, {0, 0}, {0, 290}}, 10.0, 1.0);
};

TEST_F(DrivenStreets, WaysOfOneNameAreOneStreetAndARoadWithoutANameIsSaidToHaveNone) {
  const auto driven = streets(drive);
  ASSERT_THAT(driven, ElementsAre(Field(&DrivenStreet::name, "West Street"),
                                  Field(&DrivenStreet::name, "unnamed road (residential)")));
  EXPECT_EQ(driven[0].from, 0.0);
  EXPECT_NEAR(driven[0].to, 39.0, 3.0);
  EXPECT_GT(driven[1].from, driven[0].to);
  EXPECT_NEAR(driven[0].length, 390.0, 30.0);
  EXPECT_NEAR(driven[0].length + driven[1].length, 680.0, 15.0);
  EXPECT_EQ(driven[0].fixes + driven[1].fixes, drive.size());
  for (const DrivenStreet& street : driven) EXPECT_THAT(street.probability, DoubleNear(0.9, 0.1));
}

TEST_F(DrivenStreets, AVehicleThatStandsGathersNoLength) {
  Track standing(drive.begin(), drive.begin() + 20);
  const double driven = streets(standing)[0].length;
  for (int i = 0; i < 600; ++i) {
    standing.push_back(standing.back());
    standing.back().stamp += std::chrono::seconds(1);
    standing.back().speed = 0.0;
    standing.back().position = SmallMap::place(-200.0 + (i % 2), 0.0);
  }
  EXPECT_NEAR(streets(standing)[0].length, driven, 10.0);
}

TEST_F(DrivenStreets, AFixThatWasNotUsedDoesNotEndAStreet) {
  drive.insert(drive.begin() + 15, drive[14]);
  EXPECT_THAT(streets(drive), SizeIs(2));
}

TEST_F(DrivenStreets, ATrackWithoutARoadHasNone) {
  for (auto& fix : drive) fix.position = SmallMap::place(5000.0, 5000.0);
  EXPECT_THAT(streets(drive), IsEmpty());
}

}  // namespace
}  // namespace maploop::match
