// Tests the matchers of the literature on small maps.
#include "tools/match/baseline_matchers.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"

namespace maploop::match {
namespace {

using maploop::testing::drive;
using maploop::testing::SmallMap;

constexpr double beta = 5.0;  // m

struct Baseline {
  const char* name;
  std::function<std::vector<MatchedFix>(const mapmatch::RoadNetwork&, const Track&)> match;
};

const std::vector<Baseline>& baselines() {
  static const std::vector<Baseline> all{{"nearest", nearest_segments},
                                         {"weights", topological_weights},
                                         {"ellipse", probabilistic_ellipse},
                                         {"HMM", [](const auto& network, const auto& track) {
                                            return hidden_markov(network, track, beta);
                                          }}};
  return all;
}

// Way 10 leads from west to east through the middle, way 20 from south to north.
SmallMap crossroads() {
  SmallMap map;
  map.node(1, -300, 0).node(2, 0, 0).node(3, 300, 0).node(4, 0, 300).node(5, 0, -300);
  map.way(10, {1, 2, 3}).way(20, {5, 2, 4});
  return map;
}

TEST(BaselineMatchers, FollowAStreetAndATurn) {
  const auto network = crossroads().network();
  for (const double rate : {1.0, 10.0}) {
    const Track track = drive({{-250, 0}, {0, 0}, {0, 250}}, 10.0, rate, 2.0);
    for (const Baseline& baseline : baselines()) {
      const auto matched = baseline.match(network, track);
      ASSERT_EQ(matched.size(), track.size()) << baseline.name;
      for (std::size_t i = 0; i < track.size(); ++i) {
        const double second = static_cast<double>(i) / rate;
        if (second > 22.0 && second < 28.0) continue;
        EXPECT_EQ(matched[i].way_id, second < 25.0 ? 10 : 20)
            << baseline.name << " at " << second << " s";
      }
    }
  }
}

TEST(BaselineMatchers, MatchNothingFarFromEveryRoad) {
  const auto network = crossroads().network();
  const Track track = drive({{2000, 2000}, {2100, 2000}}, 10.0, 1.0);
  for (const Baseline& baseline : baselines()) {
    for (const MatchedFix& fix : baseline.match(network, track))
      EXPECT_FALSE(fix.way_id) << baseline.name;
    EXPECT_TRUE(baseline.match(network, {}).empty()) << baseline.name;
  }
}

// The fixes come nearer to a parallel road, which no road joins to the one before.
TEST(BaselineMatchers, HiddenMarkovStaysOnTheRoadThatLeadsOn) {
  SmallMap map;
  map.node(1, -300, 0).node(2, 300, 0).node(3, -300, 12).node(4, 300, 12);
  map.way(10, {1, 2}).way(30, {3, 4});
  const auto network = map.network();
  Track track = drive({{-250, 0}, {250, 0}}, 10.0, 1.0);
  const Track beside = drive({{-250, 7}, {250, 7}}, 10.0, 1.0);
  for (std::size_t i = 20; i < 24; ++i) track[i] = beside[i];
  const auto nearest = nearest_segments(network, track);
  const auto model = hidden_markov(network, track, beta);
  EXPECT_EQ(nearest[22].way_id, 30);
  for (const MatchedFix& fix : model) EXPECT_EQ(fix.way_id, 10);
}

TEST(BaselineMatchers, HiddenMarkovGoesOnBehindAGapInTheMap) {
  SmallMap map;
  map.node(1, -300, 0).node(2, -100, 0).node(3, 100, 0).node(4, 300, 0);
  map.way(10, {1, 2}).way(30, {3, 4});
  const auto network = map.network();
  const auto matched = hidden_markov(network, drive({{-250, 0}, {250, 0}}, 10.0, 1.0), beta);
  EXPECT_EQ(matched.front().way_id, 10);
  EXPECT_FALSE(matched[25].way_id) << "no road is near";
  EXPECT_EQ(matched.back().way_id, 30);
}

}  // namespace
}  // namespace maploop::match
