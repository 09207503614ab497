// Tests the map in the loop on recorded drives, without GNSS after the first 10 s: a MEMS unit's
// noise, wheels that measure 1 % too much. The bounds are the results, with a margin.
#include "tools/experiment/map_experiment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "mapmatch/osm_reader.h"
#include "tests/support/real_data.h"

namespace maploop::experiments {
namespace {

struct World {
  mapmatch::MapExtract map;
  MapSetting setting;

  World()
      : map(mapmatch::read_osm(maploop::testing::real_data() / "maps/karlsruhe_2012-04.osm.pbf")) {
    setting.folder = maploop::testing::real_data() / "kitti_odometry";
    setting.extract = &map;
    setting.roads = std::make_shared<const vehicle::RoadMap>(
        vehicle::RoadMap{mapmatch::RoadNetwork(mapmatch::build_network(map)),
                         mapmatch::read_rule_bases(mapmatch::default_rules())});
  }
};

const World& world() {
  static const World world;
  return world;
}

MapResult driven(const std::string& sequence, MapMode mode, const std::string& fault = "",
                 std::int64_t seed = 1) {
  MapCase c;
  c.sequence = sequence;
  c.mode = mode;
  c.fault = fault;
  c.seed = seed;
  return run(world().setting, c);
}

double cross_track_rms(const MapResult& r) {
  double sum = 0.0, count = 0.0;
  for (const MapSample& s : r.samples) {
    if (s.time < 10.0) continue;
    const double cross = s.error.x() * std::cos(s.azimuth) - s.error.y() * std::sin(s.azimuth);
    sum += cross * cross;
    count += 1.0;
  }
  return std::sqrt(sum / std::max(1.0, count));
}

struct Reached {
  const char* sequence;
  double rmse, max;  // m
  double link;       // share of the certain frames that is right
};

void PrintTo(const Reached& reached, std::ostream* stream) {
  *stream << reached.sequence;
}

class TightOnTurns : public ::testing::TestWithParam<Reached> {};

// This includes the gaps of 1.7 s in the inertial data: nine in 00, three in 02.
TEST_P(TightOnTurns, StaysNearTheTruthAndOnTheLink) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const MapResult tight = driven(GetParam().sequence, MapMode::tight);
  const MapResult loose = driven(GetParam().sequence, MapMode::loose);
  const fusion_score::Errors& e = without_gnss(tight);
  EXPECT_LT(e.rmse, GetParam().rmse);
  EXPECT_LT(e.max, GetParam().max);
  EXPECT_GE(tight.match.certain.share(), GetParam().link);
  EXPECT_GE(tight.match.certain.share(), loose.match.certain.share());
  EXPECT_GT(without_gnss(loose).rmse, 2.0 * e.rmse);
  EXPECT_EQ(tight.restorations, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Sequences, TightOnTurns,
    ::testing::Values(Reached{"00", 1.5, 5.0, 0.99}, Reached{"02", 2.0, 5.6, 0.99},
                      Reached{"06", 1.8, 3.5, 0.99}, Reached{"08", 1.9, 3.6, 0.99},
                      Reached{"10", 2.7, 4.0, 0.99}),
    [](const auto& reached) { return std::string("Of") + reached.param.sequence; });

// The recorder's speed contradicts its positions by 4 m in the first 40 s of 08: after an unlucky
// start the first turn is 15 m from where it is expected, more than three of its sigmas.
TEST(Tight, FindsItsRoadBehindATurnThatComesUnexpected) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const MapResult r = driven("08", MapMode::tight, "", 4);
  EXPECT_LT(without_gnss(r).rmse, 5.0);
  EXPECT_GE(r.match.certain.share(), 0.99);
}

TEST(TightOnStraightRoads, IsNoWorseAcrossThanWithoutTheMap) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const char* sequence : {"01", "04"}) {
    const MapResult tight = driven(sequence, MapMode::tight);
    const MapResult none = driven(sequence, MapMode::none);
    EXPECT_LT(cross_track_rms(tight), cross_track_rms(none) + 0.5) << sequence;
  }
}

TEST(HardReset, SaysItKnowsMoreThanItDoes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const double hard = without_gnss(driven("08", MapMode::hard_reset)).nees_mean;
  EXPECT_GT(hard, 20.0);
  EXPECT_LT(without_gnss(driven("08", MapMode::tight)).nees_mean, 0.2 * hard);
}

// With two degrees of freedom a mean of 2 is expected. The mean of one drive is printed but not
// tested; that of four together shows whether the covariance has the right size.
TEST(Tight, KnowsHowWellItKnows) {
  MAPLOOP_REQUIRE_REAL_DATA();
  double sum = 0.0, count = 0.0;
  for (const char* sequence : {"02", "06", "08", "10"}) {
    const MapResult r = driven(sequence, MapMode::tight);
    for (const MapSample& s : r.samples) sum += s.time > 10.0 ? s.nees : 0.0;
    count += static_cast<double>(r.samples.size());
  }
  EXPECT_GT(sum / count, 0.5);
  EXPECT_LT(sum / count, 3.0);
}

TEST(Tight, CountsWhatTheGuardUndoes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapSetting setting = world().setting;
  setting.config.guard.difference_gate = 0.01;  // any difference speaks against the road
  MapCase c;
  c.sequence = "10";
  EXPECT_GT(run(setting, c).restorations, 0u);
}

class WrongMaps : public ::testing::TestWithParam<const char*> {};

TEST_P(WrongMaps, DoNotDragTheVehicleAway) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const char* sequence : {"06", "10"}) {
    const MapResult free = driven(sequence, MapMode::none);
    const MapResult tight = driven(sequence, MapMode::tight, GetParam());
    const Comparison c = compare(tight, free);
    EXPECT_EQ(c.worse, 0.0) << sequence << ": by " << c.worst_excess << " m";
    if (tight.missing != 0) {
      EXPECT_LT(c.probability_on_missing, 0.2) << sequence;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, WrongMaps,
                         ::testing::Values("missing", "shifted 5 m", "shifted 10 m", "reversed",
                                           "parallel 12 m"),
                         [](const auto& fault) {
                           std::string name = fault.param;
                           std::erase(name, ' ');
                           return name;
                         });

}  // namespace
}  // namespace maploop::experiments
