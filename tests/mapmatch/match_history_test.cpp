// These tests check on hand-made maps what later fixes tell of earlier ones.
#include "mapmatch/match_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/mapmatch/default_rule_bases.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::drive;
using maploop::testing::rules;
using maploop::testing::SmallMap;
using Results = std::vector<MatchResult>;

// A road that forks in two, which are 8 m apart after 500 m and then part.
RoadNetwork fork() {
  SmallMap map;
  map.node(1, -500, 0).node(2, 0, 0).node(3, 500, 4).node(4, 500, -4);
  map.node(5, 700, 200).node(6, 700, -200);
  return map.way(10, {1, 2}).way(11, {2, 3, 5}).way(12, {2, 4, 6}).network();
}

struct Matched {
  Results now;
  MatchHistory history;
};

Matched matched(const RoadNetwork& network, const std::vector<VehicleFix>& fixes,
                const MatchParameters& parameters = {}) {
  Matcher matcher(network, rules(), parameters);
  Matched all{{}, MatchHistory(network)};
  for (const VehicleFix& fix : fixes) {
    all.now.push_back(matcher.add(fix));
    all.history.add(all.now.back(), matcher);
  }
  return all;
}

std::int64_t way_of(const RoadNetwork& network, const MatchResult& result) {
  return result.on_road ? network.road_at(result.point.vertex).way_id : 0;
}

// The vehicle takes the northern branch; until it turns off, it can be on either.
std::vector<VehicleFix> through_the_fork() {
  auto fixes = drive({{-490, 0}, {0, 0}, {500, 0}, {690, 190}}, 10.0, 10.0);
  for (VehicleFix& fix : fixes) fix.covariance = 100.0 * Eigen::Matrix2d::Identity();
  return fixes;
}

TEST(MatchHistory, WithoutALagTheLinksAreThoseOfTheInstant) {
  const RoadNetwork network = fork();
  const Matched all = matched(network, drive({{-490, 0}, {0, 0}, {500, 4}}, 10.0, 10.0));
  const Results later = all.history.judged_after(Duration::zero());
  ASSERT_EQ(later.size(), all.now.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < later.size(); ++i) {
    EXPECT_EQ(later[i].stamp, all.now[i].stamp);
    same += later[i].link == all.now[i].link ? 1 : 0;
  }
  // The rules, which the instant uses too, may decide otherwise near the junction.
  EXPECT_GE(same + 20, later.size());
}

TEST(MatchHistory, TheBranchThatWasTakenIsKnownAfterwards) {
  const RoadNetwork network = fork();
  const Matched all = matched(network, through_the_fork());
  const Results later = all.history.judged_after(std::chrono::seconds(60));
  double least_now = 1.0;
  for (std::size_t i = 0; i < later.size(); ++i) {
    const double east = 10.0 * to_seconds(later[i].stamp - later[0].stamp) - 490.0;
    if (east < 100.0 || east > 480.0) continue;
    EXPECT_EQ(way_of(network, later[i]), 11) << east;
    EXPECT_GT(later[i].probability, 0.85) << east;
    least_now = std::min(least_now, all.now[i].probability);
  }
  EXPECT_LT(least_now, 0.7) << "at once it could not be told";
}

TEST(MatchHistory, ProbabilitiesOfAFixAddUpToOneAtMost) {
  const RoadNetwork network = fork();
  for (const double lag : {0.0, 1.0, 3.0, 1000.0}) {
    for (const MatchResult& r :
         matched(network, through_the_fork()).history.judged_after(from_seconds(lag))) {
      double sum = r.off_road;
      for (std::size_t i = 0; i < r.candidate_count; ++i) sum += r.candidates[i].probability;
      EXPECT_LE(sum, 1.0 + 1e-9) << lag;
    }
  }
}

TEST(MatchHistory, TheRoadWasLeftWhereItEnded) {
  const RoadNetwork network = SmallMap().node(1, -500, 0).node(2, 0, 0).way(10, {1, 2}).network();
  const auto fixes = drive({{-490, 0}, {0, 0}, {0, 400}}, 10.0, 10.0);
  const Matched all = matched(network, fixes);
  const auto first_off = [](const Results& results) {
    const auto off = std::find_if(results.begin() + 100, results.end(),
                                  [](const MatchResult& r) { return !r.on_road; });
    return off - results.begin();
  };
  const auto now = first_off(all.now);
  const auto later = first_off(all.history.judged_after(std::chrono::seconds(10)));
  EXPECT_LT(later, now);
  EXPECT_GT(later, 485);
}

TEST(MatchHistory, FixesThatWereRefusedAndABreakStayAsTheyWere) {
  const RoadNetwork network = fork();
  auto fixes = drive({{-490, 0}, {0, 0}}, 10.0, 10.0);
  fixes.insert(fixes.begin() + 50, 3, fixes[49]);
  for (std::size_t i = 300; i < fixes.size(); ++i) fixes[i].stamp += std::chrono::seconds(1000);
  const Results later = matched(network, fixes).history.judged_after(Duration::max());
  ASSERT_EQ(later.size(), fixes.size());
  for (std::size_t i = 50; i < 53; ++i) EXPECT_EQ(later[i].refusal, FixRefusal::not_later);
  EXPECT_TRUE(later.front().on_road && later.back().on_road);
}

TEST(MatchHistory, WithTheRulesAloneNothingChanges) {
  const RoadNetwork network = fork();
  MatchParameters parameters;
  parameters.paths = false;
  const Matched all = matched(network, drive({{-490, 0}, {0, 0}}, 10.0, 10.0), parameters);
  const Results later = all.history.judged_after(std::chrono::seconds(3));
  for (std::size_t i = 0; i < later.size(); ++i) {
    EXPECT_EQ(later[i].on_road, all.now[i].on_road);
    EXPECT_EQ(later[i].likelihood, all.now[i].likelihood);
  }
  EXPECT_TRUE(MatchHistory(network).judged_after(Duration::zero()).empty());
}

}  // namespace
}  // namespace maploop::mapmatch
