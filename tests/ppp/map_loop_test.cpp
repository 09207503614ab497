// Tests a real drive on one frequency with a map made from other drives on the same streets.
#include "tools/ppp/map_loop.h"

#include <gtest/gtest.h>

#include "mapmatch/network_file.h"
#include "mapmatch/ppp_fix.h"
#include "tests/support/real_data.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::gnss {
namespace {

struct Driven {
  double across = 0.0, across_free = 0.0;          // m, root mean square
  double horizontal = 0.0, horizontal_free = 0.0;  // m
  std::uint64_t used = 0, restorations = 0;
  std::size_t matched = 0;
};

// Runs the whole drive; the map is shifted by `shift` m to the east.
Driven riverside(bool tight, double shift = 0.0) {
  const auto data = maploop::testing::real_data();
  ppp::GnssFiles files;
  read_into(data / "gnss/riverside_drive/COM3_200712.obs.gz", files);
  read_into(data / "gnss/riverside_drive/COM3_200712.nav.gz", files);
  // The ionosphere is that of 17 days earlier.
  read_into(data / "gnss/esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz", files);
  mapmatch::NetworkData map =
      mapmatch::open_network(data / "maps/riverside/riverside_from_2021_drives.osm.pbf");
  for (mapmatch::Vertex& v : map.vertices) v.east += shift;
  const auto roads = std::make_shared<const vehicle::RoadMap>(vehicle::RoadMap{
      mapmatch::RoadNetwork(std::move(map)), mapmatch::read_rule_bases(mapmatch::default_rules())});
  const Truth truth((data / "gnss/riverside_drive/groundtruth.csv.gz").string(),
                    files.observations[0].epochs[0].time);
  RunOptions options;
  options.parameters.systems = "GEC";
  options.map = MapOptions{roads, {}, {}, tight};
  PppRun run(files, options);
  Score with(truth, 1e-4), without(truth, 1e-4);
  Driven driven;
  run.process([&](const ppp::PppSolution& s) {
    with.add(s);
    without.add(run.filter().map_free());
    driven.matched += run.map_step().way_id.has_value();
  });
  driven.across = with.accuracy().across_rmse;
  driven.across_free = without.accuracy().across_rmse;
  driven.horizontal = with.accuracy().horizontal_rmse;
  driven.horizontal_free = without.accuracy().horizontal_rmse;
  driven.used = run.filter().count(ppp::MapUse::used);
  driven.restorations = run.filter().restorations();
  return driven;
}

// A map that is good to metres adds nothing to a position that is known to decimetres, and must not
// take anything away. The bounds are a little above what is reached: 0.166 m with the map, 0.162 m
// without.
TEST(PppMapLoop, ARoadMapOfOtherDrivesDoesNoHarmToABetterPosition) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven d = riverside(true);
  EXPECT_GT(d.used, 0U);
  EXPECT_GT(d.matched, 2200U);
  EXPECT_LT(d.across, 0.17);
  EXPECT_LT(d.across, 1.05 * d.across_free);
  EXPECT_LT(d.horizontal, 1.05 * d.horizontal_free);
}

TEST(PppMapLoop, LooseMatchesAndChangesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven d = riverside(false);
  EXPECT_GT(d.matched, 2200U);
  EXPECT_EQ(d.used, 0U);
  EXPECT_EQ(d.across, d.across_free);
}

TEST(PppMapLoop, AMapThatIsTenMetresOffDoesNoHarm) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven d = riverside(true, 10.0);
  EXPECT_LT(d.across, 1.05 * d.across_free);
  EXPECT_LT(d.horizontal, 1.05 * d.horizontal_free);
}

TEST(PppFix, HasTheDirectionOfTravelOfWhatMoves) {
  PppState state;
  state.velocity_enu = {3.0, 4.0, 0.1};
  state.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  state.position_covariance = 2.0 * Eigen::Matrix3d::Identity();
  const mapmatch::VehicleFix fix = mapmatch::fix_of(state);
  EXPECT_NEAR(fix.speed, 5.0, 1e-12);
  EXPECT_NEAR(fix.azimuth, std::atan2(3.0, 4.0), 1e-12);
  EXPECT_NEAR(fix.azimuth_sigma, 0.1 / 5.0, 1e-12);
  EXPECT_NEAR(fix.covariance(0, 0), 2.0, 1e-12);
  state.velocity_enu = {0.3, 0.0, 0.0};
  EXPECT_TRUE(std::isnan(mapmatch::fix_of(state).azimuth)) << "standing";
}

}  // namespace
}  // namespace maploop::gnss
