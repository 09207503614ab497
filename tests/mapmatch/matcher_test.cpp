// These tests cover odd cases of map matching on hand-made maps.
#include "mapmatch/matcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapmatch/reasons.h"
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
using Places = std::vector<Eigen::Vector2d>;

std::int64_t way_of(const Matcher& matcher, const MatchResult& r) {
  return r.on_road ? matcher.network().road_at(r.point.vertex).way_id : 0;
}

// Returns the way of each fix; 0 if there is none.
std::vector<std::int64_t> ways(Matcher& matcher, const std::vector<VehicleFix>& fixes) {
  std::vector<std::int64_t> found;
  found.reserve(fixes.size());
  for (const VehicleFix& fix : fixes) found.push_back(way_of(matcher, matcher.add(fix)));
  return found;
}

// The map is a street from west to east (way 10) and another across it (way 20), with nodes 1 to 5
// and node 2 in the middle.
SmallMap crossing() {
  SmallMap map;
  map.node(1, -300, 0).node(2, 0, 0).node(3, 300, 0).node(4, 0, 300).node(5, 0, -300);
  map.way(10, {1, 2, 3}).way(20, {5, 2, 4});
  return map;
}

std::vector<VehicleFix> standing(VehicleFix fix, int count, double interval) {
  fix.speed = 0.0;
  fix.azimuth = unknown;
  std::vector<VehicleFix> fixes;
  for (int i = 0; i < count; ++i) {
    fix.stamp += from_seconds(interval);
    fixes.push_back(fix);
  }
  return fixes;
}

TEST(Matcher, FindsItsLinkByInitialMatchingAndStaysAlongIt) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  const auto fixes = drive({{-250, 0}, {-50, 0}}, 10.0, 1.0, 2.0);
  EXPECT_EQ(matcher.add(fixes[0]).phase, MatchPhase::initial);
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const MatchResult& r = matcher.add(fixes[i]);
    EXPECT_EQ(way_of(matcher, r), 10);
    EXPECT_EQ(r.phase, i < 3 ? MatchPhase::initial : MatchPhase::along_link) << i;
    EXPECT_GT(r.probability, 0.9);
  }
}

TEST(Matcher, FollowsATurnAtAJunction) {
  for (const double rate : {1.0, 5.0, 10.0}) {
    const RoadNetwork network = crossing().network();
    Matcher matcher(network, rules(), {});
    const auto fixes = drive({{-250, 0}, {0, 0}, {0, 250}}, 10.0, rate);
    const auto found = ways(matcher, fixes);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double t = to_seconds(fixes[i].stamp - fixes[0].stamp);
      if (std::abs(t - 25.0) < 1.2) continue;  // within 12 m of the junction either is correct
      EXPECT_EQ(found[i], t < 25.0 ? 10 : 20) << rate << " Hz, " << t << " s";
    }
  }
}

TEST(Matcher, DecidesTheSameAt1And5And10Hz) {
  const RoadNetwork network = crossing().network();
  std::vector<std::vector<std::int64_t>> by_second;
  for (const int rate : {1, 5, 10}) {
    Matcher matcher(network, rules(), {});
    const auto found = ways(matcher, drive({{-250, 3}, {4, 3}, {4, -250}}, 9.0, rate, 1.0));
    std::vector<std::int64_t> each_second;
    for (std::size_t i = 0; i < found.size(); i += static_cast<std::size_t>(rate))
      each_second.push_back(found[i]);
    by_second.push_back(each_second);
  }
  ASSERT_GT(by_second[0].size(), 50u);
  EXPECT_EQ(by_second[0], by_second[1]);
  EXPECT_EQ(by_second[0], by_second[2]);
}

TEST(Matcher, AzimuthsAreWrapped) {
  const RoadNetwork network = SmallMap().node(1, 0, -300).node(2, 0, 300).way(10, {1, 2}).network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{0, 250}, {0, -250}}, 10.0, 1.0);  // southwards: +-180 degrees
  for (std::size_t i = 0; i < fixes.size(); ++i)
    fixes[i].azimuth = (i % 2 ? 1.0 : -1.0) * radians(179.5);
  for (const VehicleFix& fix : fixes) {
    const MatchResult& r = matcher.add(fix);
    ASSERT_TRUE(r.on_road);
    EXPECT_FALSE(r.link.forward);
    EXPECT_LT(r.candidates[0].azimuth_error, radians(1.0));
    EXPECT_GT(r.likelihood, 50.0);
  }
}

TEST(Matcher, AUTurnInTheMiddleOfALinkIsFollowed) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  std::vector<bool> forward;
  for (const VehicleFix& fix : drive({{-280, 0}, {-120, 0}, {-120, 5}, {-280, 5}}, 6.0, 10.0)) {
    const MatchResult& r = matcher.add(fix);
    ASSERT_TRUE(r.on_road);
    EXPECT_EQ(way_of(matcher, r), 10);
    forward.push_back(r.link.forward);
  }
  EXPECT_NE(forward[100], forward.back());
}

TEST(Matcher, StandingForAnHourChangesNothing) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  const auto fixes = drive({{-250, 0}, {-8, 0}}, 10.0, 10.0);
  ways(matcher, fixes);
  const auto still = standing(fixes.back(), 36000, 0.1);
  for (const VehicleFix& fix : still) {
    const MatchResult& r = matcher.add(fix);
    ASSERT_EQ(way_of(matcher, r), 10);
    ASSERT_EQ(r.phase, MatchPhase::along_link);
  }
}

TEST(Matcher, ParallelRoadsAreToldApartByWhereTheVehicleCameFrom) {
  SmallMap map;  // they part at node 2, 12 m apart after 60 m
  map.node(1, -300, 0).node(2, 0, 0).node(3, 60, 12).node(4, 600, 12).node(5, 600, 0);
  map.way(10, {1, 2, 5}).way(20, {2, 3, 4});
  const RoadNetwork network = map.network();
  for (const double north : {0.0, 12.0}) {
    Matcher matcher(network, rules(), {});
    const auto fixes = drive({{-250, 0}, {0, 0}, {60, north}, {580, north}}, 12.0, 1.0);
    const auto found = ways(matcher, fixes);
    for (std::size_t i = 30; i < found.size(); ++i) EXPECT_EQ(found[i], north > 0 ? 20 : 10) << i;
  }
}

TEST(Matcher, ABridgeOverTheRoadDoesNotTakeTheVehicle) {
  SmallMap map;
  Road bridge;
  bridge.bridge = true;
  bridge.layer = 1;
  map.node(1, -300, 0).node(3, 300, 0).node(4, 0, 300).node(5, 0, -300);
  map.way(10, {1, 3}).way(20, {5, 4}, bridge);  // they cross without a node
  const RoadNetwork network = map.network();
  Matcher matcher(network, rules(), {});
  for (const std::int64_t way : ways(matcher, drive({{-250, 0}, {250, 0}}, 10.0, 10.0)))
    EXPECT_EQ(way, 10);
}

TEST(Matcher, ATunnelWithoutFixesIsCrossedAndAWanderingFixInItForgiven) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-280, 0}, {280, 0}}, 10.0, 1.0);
  fixes.erase(fixes.begin() + 15, fixes.begin() + 23);  // 8 s
  fixes[15].position = SmallMap::place(-40, 90);        // the first one after it
  fixes[15].covariance *= 900.0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const MatchResult& r = matcher.add(fixes[i]);
    if (i != 15) {
      EXPECT_EQ(way_of(matcher, r), 10) << i;
    }
  }
}

TEST(Matcher, AfterALongGapMatchingBeginsAgain) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-280, 0}, {280, 0}}, 10.0, 1.0);
  ways(matcher, fixes);
  VehicleFix elsewhere = fixes.back();
  elsewhere.stamp += std::chrono::minutes(5);
  elsewhere.position = SmallMap::place(0, 150);
  elsewhere.azimuth = 0.0;
  const MatchResult& r = matcher.add(elsewhere);
  EXPECT_EQ(r.phase, MatchPhase::initial);
  EXPECT_EQ(way_of(matcher, r), 20);
}

TEST(Matcher, OneBadFixIsNotFatal) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-280, 0}, {280, 0}}, 10.0, 1.0);
  fixes[20].position = SmallMap::place(3000, 3000);
  const auto found = ways(matcher, fixes);
  for (std::size_t i = 22; i < found.size(); ++i) EXPECT_EQ(found[i], 10) << i;
}

TEST(Matcher, AParkingLotIsOffTheRoadAndTheRoadIsFoundAgain) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  const auto fixes = drive(
      {{-280, 0}, {-150, 0}, {-150, 80}, {-90, 140}, {-90, 60}, {-60, 0}, {250, 0}}, 8.0, 10.0);
  bool was_off = false;
  for (const VehicleFix& fix : fixes) {
    const MatchResult& r = matcher.add(fix);
    const Eigen::Vector2d p = network.to_local(fix.position);
    if (p.y() > 40.0) {
      EXPECT_FALSE(r.on_road && r.probability > 0.9) << p.transpose();
    }
    was_off |= r.phase == MatchPhase::off_road;
    if (p.x() > -10.0) {  // 50 m on the road again
      EXPECT_EQ(way_of(matcher, r), 10) << p.transpose();
    }
  }
  EXPECT_TRUE(was_off);
}

TEST(Matcher, FarFromEveryRoadThereIsNoLink) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  for (const VehicleFix& fix : drive({{5000, 5000}, {5200, 5000}}, 10.0, 1.0)) {
    const MatchResult& r = matcher.add(fix);
    EXPECT_FALSE(r.on_road);
    EXPECT_EQ(r.candidate_count, 0u);
    EXPECT_EQ(explanation(r, network), "no road near");
  }
}

TEST(Matcher, AnEmptyNetworkIsHarmless) {
  const RoadNetwork network{NetworkData{}};
  Matcher matcher(network, rules(), {});
  for (const VehicleFix& fix : drive({{0, 0}, {50, 0}}, 10.0, 1.0))
    EXPECT_FALSE(matcher.add(fix).on_road);
}

TEST(Matcher, AOneWayStreetAgainstItsDirectionIsDoubtedAndSaidSo) {
  SmallMap map;
  map.node(1, -300, 0).node(2, 300, 0).way(10, {1, 2}, one_way());
  const RoadNetwork network = map.network();
  Matcher with(network, rules(), {}), against(network, rules(), {});
  double p_with = 0.0, p_against = 0.0;
  for (const VehicleFix& fix : drive({{-250, 0}, {0, 0}}, 10.0, 1.0))
    p_with = with.add(fix).probability;
  std::vector<std::string> said;
  for (const VehicleFix& fix : drive({{250, 0}, {0, 0}}, 10.0, 1.0)) {
    const MatchResult& r = against.add(fix);
    p_against = r.probability;
    said = objections(r.candidates[0], network);
  }
  EXPECT_LT(p_against, p_with);
  EXPECT_THAT(said, ::testing::Contains("against its one-way direction"));
}

// The street ends, the vehicle goes on, and another street begins beside it that the map does not
// join to the first one.
TEST(Matcher, ALinkNotReachedAlongTheMapIsDoubtedUntilItHasFittedForAWhile) {
  SmallMap map;
  map.node(1, -300, 0).node(2, 0, 0).node(3, 60, 0).node(4, 700, 0);
  map.way(10, {1, 2}).way(20, {3, 4});
  const RoadNetwork network = map.network();
  Matcher matcher(network, rules(), {});
  for (const VehicleFix& fix : drive({{-250, 0}, {650, 0}}, 10.0, 1.0)) {
    const MatchResult& r = matcher.add(fix);
    const double past = network.to_local(fix.position).x() - network.vertex(2).position().x();
    if (way_of(matcher, r) == 20 && past < 50.0) {
      EXPECT_LT(r.probability, 0.9) << past;
    }
    if (past > 200.0) {
      EXPECT_EQ(way_of(matcher, r), 20) << past;
      EXPECT_GT(r.probability, 0.9) << past;
    }
  }
}

// A wide turn at walking pace lasts for many seconds in which neither street fits well.
TEST(Matcher, ASlowWideTurnIsNotOffTheRoad) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  ways(matcher, drive({{-150, -3}, {-12, -3}}, 8.0, 10.0));
  auto fixes = drive({{-12, -3}, {-11, 6}, {-9, 14}, {-3, 20}, {-3, 40}}, 1.2, 10.0);
  for (VehicleFix& fix : fixes) {
    fix.stamp += std::chrono::seconds(60);
    EXPECT_NE(matcher.add(fix).phase, MatchPhase::off_road);
  }
}

TEST(Matcher, OnlyPositionsAreEnough) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-250, 0}, {0, 0}, {0, 250}}, 10.0, 1.0);
  for (VehicleFix& fix : fixes) fix.speed = fix.azimuth = unknown;
  const auto found = ways(matcher, fixes);
  for (std::size_t i = 3; i < found.size(); ++i) {
    if (i < 23 || i > 28) {
      EXPECT_EQ(found[i], i < 25 ? 10 : 20) << i;
    }
  }
}

TEST(Matcher, FixesThatCannotBeUsedAreRefusedWithAReasonAndChangeNothing) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  const auto fixes = drive({{-250, 0}, {-100, 0}}, 10.0, 1.0);
  for (std::size_t i = 0; i < 10; ++i) matcher.add(fixes[i]);
  const Bytes before = maploop::testing::saved(matcher);
  VehicleFix bad = fixes[5];
  EXPECT_EQ(matcher.add(bad).refusal, FixRefusal::not_later);
  bad = fixes[10];
  bad.position.latitude = unknown;
  EXPECT_EQ(matcher.add(bad).refusal, FixRefusal::not_finite);
  bad = fixes[10];
  bad.position.longitude = 1e9;
  EXPECT_EQ(matcher.add(bad).refusal, FixRefusal::not_finite);
  bad = fixes[10];
  bad.covariance << 1.0, 2.0, 2.0, 1.0;
  EXPECT_EQ(matcher.add(bad).refusal, FixRefusal::bad_covariance);
  EXPECT_EQ(maploop::testing::saved(matcher), before);
  EXPECT_EQ(matcher.add(fixes[10]).refusal, FixRefusal::none);
}

TEST(Matcher, AFixOutOfReachIsRefusedAndTheNextOneIsNot) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-250, 0}, {-50, 0}}, 10.0, 1.0);
  const auto undisturbed = ways(matcher, fixes);
  VehicleFix& wild = fixes[8];
  wild.position.latitude += radians(0.01);  // 1.1 km
  Matcher disturbed(network, rules(), {});
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const MatchResult& result = disturbed.add(fixes[i]);
    EXPECT_EQ(result.refusal, i == 8 ? FixRefusal::out_of_reach : FixRefusal::none);
    EXPECT_EQ(result.on_road, undisturbed[i] != 0) << i;
  }
}

TEST(Matcher, WhereSeveralFixesAgreeTheVehicleIsThere) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  auto fixes = drive({{-250, 0}, {-50, 0}}, 10.0, 1.0);
  for (std::size_t i = 0; i < 3; ++i) fixes[i].position = {};  // a receiver without a position
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    EXPECT_EQ(matcher.add(fixes[i]).refusal, i == 3 ? FixRefusal::out_of_reach : FixRefusal::none);
  }
}

TEST(Matcher, ReasonsStateWhatContradictsTheOtherStreet) {
  const RoadNetwork network = crossing().network();
  Matcher matcher(network, rules(), {});
  MatchResult last;
  for (const VehicleFix& fix : drive({{-100, 0}, {-4, 0}}, 8.0, 1.0)) last = matcher.add(fix);
  EXPECT_THAT(explanation(last, network), ::testing::HasSubstr("way 10, P "));
  std::vector<std::string> across;
  for (std::size_t i = 0; i < last.candidate_count; ++i) {
    const MatchCandidate& c = last.candidates[i];
    if (network.road_at(network.link(c.link.link).first_vertex).way_id == 20)
      across = objections(c, network);
  }
  EXPECT_THAT(across, ::testing::Contains("azimuth differs by 90 degrees"));
  EXPECT_FALSE(fired_rules(last.candidates[0], rules()).empty());
}

TEST(Matcher, TheRulesAloneFollowAStreetAndATurn) {
  const RoadNetwork network = crossing().network();
  MatchParameters parameters;
  parameters.paths = false;
  Matcher matcher(network, rules(), parameters);
  const auto found = ways(matcher, drive({{-250, 0}, {0, 0}, {0, 250}}, 10.0, 1.0));
  for (std::size_t i = 4; i < found.size(); ++i) {
    EXPECT_NE(found[i], 0) << i << ": matching starts again with the fix that fits no link behind";
    if (i < 23 || i > 30) {
      EXPECT_EQ(found[i], i < 25 ? 10 : 20) << i;
    }
  }
}

TEST(Matcher, GoesOnAfterLoadingAsIfNothingHadHappened) {
  const RoadNetwork network = crossing().network();
  const auto fixes = drive({{-250, 0}, {0, 0}, {0, 250}}, 10.0, 5.0, 1.0);
  Matcher whole(network, rules(), {}), resumed(network, rules(), {});
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    whole.add(fixes[i]);
    if (i == fixes.size() / 2) maploop::testing::load(maploop::testing::saved(whole), resumed);
    if (i > fixes.size() / 2) {
      resumed.add(fixes[i]);
      ASSERT_EQ(maploop::testing::saved(resumed), maploop::testing::saved(whole)) << i;
    }
  }
}

TEST(Matcher, AnArchiveOfAnotherMapOrOtherParametersIsRefused) {
  const RoadNetwork network = crossing().network();
  const RoadNetwork other = SmallMap().node(1, 0, 0).node(2, 9, 0).way(1, {1, 2}).network();
  Matcher matcher(network, rules(), {});
  ways(matcher, drive({{-250, 0}, {0, 0}}, 10.0, 1.0));
  const Bytes archive = maploop::testing::saved(matcher);
  Matcher elsewhere(other, rules(), {});
  EXPECT_THAT(maploop::testing::refusal(archive, elsewhere),
              ::testing::HasSubstr("links of the road"));
  MatchParameters parameters;
  parameters.birth = 6.0;
  Matcher different(network, rules(), parameters);
  EXPECT_THAT(maploop::testing::refusal(archive, different), ::testing::HasSubstr("birth"));
}

TEST(Matcher, AllocatesNothing) {
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const RoadNetwork network = crossing().network();
  const auto fixes = drive({{-280, 0}, {0, 0}, {0, 280}, {9, 280}, {9, 0}}, 10.0, 10.0, 1.0);
  Matcher matcher(network, rules(), {});
  const long before = maploop::testing::thread_allocations();
  for (const VehicleFix& fix : fixes) matcher.add(fix);
  EXPECT_EQ(maploop::testing::thread_allocations(), before);
}

}  // namespace
}  // namespace maploop::mapmatch
