// Tests the messages about tracks that cannot be used with a map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mapmatch/map_area.h"
#include "msgs/frames.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tools/match/match_output.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

class UnusedFixes : public ::testing::Test {
 protected:
  MatchedTrack matched(Track fixes) const {
    mapmatch::Matcher matcher(network, rules, {});
    MatchedTrack track{std::move(fixes), {}};
    for (const auto& fix : track.fixes) track.results.push_back(matcher.add(fix));
    return track;
  }

  mapmatch::RoadNetwork network =
      SmallMap().node(1, -100, 0).node(2, 100, 0).way(10, {1, 2}).network();
  mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  Track drive = maploop::testing::drive({{-90, 0}, {90, 0}}, 10.0, 1.0);
};

TEST_F(UnusedFixes, NothingIsSaidOfADriveOnTheRoad) {
  const MatchedTrack track = matched(drive);
  EXPECT_THAT(unused_fixes(track, network), IsEmpty());
  EXPECT_EQ(why_unusable(track, network), std::nullopt);
}

TEST_F(UnusedFixes, SingleBadFixesAreCountedByTheirReason) {
  drive[5].position.latitude = mapmatch::unknown;
  drive[6].position = {radians(5429012.0), radians(458000.0), 0.0};
  drive[8].stamp = drive[7].stamp;
  drive.back().position = SmallMap::place(4000, 0);
  const MatchedTrack track = matched(drive);
  EXPECT_THAT(unused_fixes(track, network),
              ElementsAre(Pair("a value is not a number", 1),
                          Pair("farther from the fix before than a vehicle can drive", 1),
                          Pair("not a latitude and a longitude in degrees", 1),
                          Pair("not later than the fix before", 1)));
  EXPECT_EQ(why_unusable(track, network), std::nullopt);
}

TEST_F(UnusedFixes, MetresForDegreesAreNamed) {
  for (auto& fix : drive) fix.position = {radians(5429012.0), radians(458000.0), 0.0};
  EXPECT_THAT(why_unusable(matched(drive), network).value_or(""),
              HasSubstr("not a latitude and a longitude in degrees; are these metres"));
}

TEST_F(UnusedFixes, TimeThatRunsBackwardsIsNamed) {
  std::reverse(drive.begin(), drive.end());
  EXPECT_THAT(
      why_unusable(matched(drive), network).value_or(""),
      HasSubstr("17 of 18 fixes of the track cannot be used: not later than the fix before; "
                "does time run backwards?"));
}

TEST_F(UnusedFixes, WhatIsNotANumberIsNamed) {
  for (auto& fix : drive) fix.position.longitude = mapmatch::unknown;
  EXPECT_THAT(why_unusable(matched(drive), network).value_or(""),
              HasSubstr("a value is not a number"));
}

TEST_F(UnusedFixes, AMapOfAnotherPlaceIsNamedWithBothPlaces) {
  for (auto& fix : drive) std::swap(fix.position.latitude, fix.position.longitude);
  const std::string why = why_unusable(matched(drive), network).value_or("");
  EXPECT_THAT(why, HasSubstr("the map covers 49.0000 to 49.0000 N, 8.3986 to 8.4014 E"));
  EXPECT_THAT(why, HasSubstr("the track is at 8.3988 to 8.4011 N, 49.0000 to 49.0000 E"));
}

TEST_F(UnusedFixes, TheAreaOfAMapHasAMargin) {
  const mapmatch::GeographicBox area = mapmatch::area_of(network);
  EXPECT_TRUE(mapmatch::covers(area, SmallMap::place(150, 0), 60.0));
  EXPECT_FALSE(mapmatch::covers(area, SmallMap::place(150, 0), 40.0));
  EXPECT_FALSE(mapmatch::covers(area, SmallMap::place(0, -50), 40.0));
  EXPECT_EQ(mapmatch::to_text({-1.5, -0.25, 2.0, 0.5}),
            "0.2500 S to 0.5000 N, 1.5000 W to 2.0000 E");
  EXPECT_EQ(mapmatch::to_text({-117.5, -34.0, -117.25, -33.5}),
            "33.5000 to 34.0000 S, 117.2500 to 117.5000 W");
}

}  // namespace
}  // namespace maploop::match
