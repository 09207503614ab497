// Tests drives on the roads of a map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mapmatch/osm_reader.h"
#include "msgs/frames.h"
#include "tests/tools/simulate/made_drive.h"
#include "tools/simulate/town/road_map.h"
#include "tools/simulate/town/route.h"
#include "tools/simulate/town/site.h"
#include "tools/simulate/town/streets.h"

namespace maploop::simulate {
namespace {

const LocalFrame map_frame({radians(49.0), radians(8.4), 100.0});

// Nodes 100 m apart in a row, one 100 m beside the second, and one 10 m after the second.
mapmatch::MapExtract hand_made() {
  mapmatch::MapExtract map;
  const auto node = [&](std::int64_t id, double x, double y) {
    const Geodetic g = map_frame.to_geodetic({x, y, 0.0});
    map.nodes.push_back({id, degrees(g.latitude), degrees(g.longitude)});
  };
  node(1, 0, 0), node(2, 100, 0), node(3, 200, 0), node(4, 100, 100), node(5, 110, 0);
  return map;
}

void add_way(mapmatch::MapExtract& map, std::int64_t id, std::vector<std::int64_t> nodes,
             bool backward = true) {
  mapmatch::MapWay way;
  way.road.way_id = id;
  way.road.road_class = mapmatch::RoadClass::residential;
  way.road.backward = backward;
  way.nodes = std::move(nodes);
  map.ways.push_back(std::move(way));
}

TEST(OsmStreets, AreCutWhereWaysMeetAndShortOnesAreOneJunction) {
  mapmatch::MapExtract map = hand_made();
  add_way(map, 1, {1, 2, 5, 3});
  add_way(map, 2, {2, 4});
  add_way(map, 3, {5, 4}, false);
  const Streets streets = streets_of(map, map_frame);
  EXPECT_EQ(streets.junctions.size(), 4U) << "2 and 5 are one";
  ASSERT_EQ(streets.streets.size(), 4U);
  EXPECT_EQ(std::count_if(streets.streets.begin(), streets.streets.end(),
                          [](const Street& s) { return !s.backward; }),
            1);
  for (const Street& street : streets.streets) {
    EXPECT_EQ(street.centreline.front(), streets.junctions[street.from]);
    EXPECT_EQ(street.centreline.back(), streets.junctions[street.to]);
    for (std::size_t i = 1; i < street.centreline.size(); ++i)
      EXPECT_NEAR((street.centreline[i] - street.centreline[i - 1]).norm(), 2.0, 0.7);
  }
}

TEST(OsmStreets, ServiceRoadsAndClosedOnesAreNotDriven) {
  mapmatch::MapExtract map = hand_made();
  add_way(map, 1, {1, 2, 3});
  add_way(map, 2, {2, 4});
  map.ways.back().road.road_class = mapmatch::RoadClass::service;
  add_way(map, 3, {3, 4});
  map.ways.back().road.restricted = true;
  EXPECT_EQ(streets_of(map, map_frame).streets.size(), 1U);
}

TEST(Directions, LeadIntoNoDeadEndAndNeverBack) {
  mapmatch::MapExtract map = hand_made();
  add_way(map, 1, {1, 2});  // a dead end
  add_way(map, 2, {2, 3});
  add_way(map, 3, {3, 4});
  add_way(map, 4, {4, 2});
  const Streets streets = streets_of(map, map_frame);
  const Directions directions(streets);
  const auto place = [&](std::int64_t id) {
    return nearest_junction(streets, map_frame
                                         .to_enu({radians(map.nodes[id - 1].latitude),
                                                  radians(map.nodes[id - 1].longitude), 100.0})
                                         .head<2>());
  };
  for (const DirectedStreet& d : directions.exits(place(2)))
    EXPECT_EQ(directions.is_through(d), streets.end(d) != place(1));
  EXPECT_TRUE(directions.has_exit(place(1)));
  const auto route = make_route(streets, place(1), 2000.0, 1);
  for (std::size_t i = 1; i < route.size(); ++i) {
    EXPECT_NE(route[i].street, route[i - 1].street);
    EXPECT_NE(streets.end(route[i]), place(1));
  }
  const auto by = make_route(streets, {place(1), place(4), place(3)}, 10.0, 1);
  ASSERT_EQ(by.size(), 3U);
  EXPECT_EQ(streets.end(by[1]), place(4));
  EXPECT_EQ(streets.end(by[2]), place(3));
  EXPECT_THROW(make_route(streets, {place(4), place(1)}, 1e4, 1), std::runtime_error)
      << "from there it goes nowhere";
}

TEST(OsmStreets, OfATownsOwnMapAreTheTowns) {
  const maploop::testing::TemporaryFolder folder;
  const Streets town = make_town(1);
  write_road_map(folder.path() / "map.osm", town, map_frame, 1, {0.0, 300.0, 0.0});
  const Streets read = streets_of(mapmatch::read_osm(folder.path() / "map.osm"), map_frame);
  ASSERT_EQ(read.streets.size(), town.streets.size());
  const StreetIndex index(town, 2.0);
  for (const Street& street : read.streets)
    for (const Eigen::Vector2d& p : street.centreline)
      EXPECT_LT(std::fabs(index.nearest(p).first.left), 0.5);
}

class Karlsruhe : public ::testing::Test {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }
  static SimulationOptions options(std::uint64_t seed) {
    SimulationOptions o;
    o.seconds = 120.0;
    o.seed = seed;
    o.map = maploop::testing::real_data() / "maps/karlsruhe_2012-04.osm.pbf";
    return o;
  }
};

TEST_F(Karlsruhe, TheCarStaysOnTheRoadAndDrivesAsADriverDoes) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Site site = choose_site(options(seed));
    const VehicleMotion motion = drive_along(site.streets, site.route, Terrain(seed), 120.0, seed);
    const StreetIndex index(site.streets, 5.0);
    int off = 0, all = 0;
    for (double t = 0.0; t < 120.0; t += 0.1, ++all) {
      // The corners of a kerb are not rounded: turns cut them, but stay clear of objects beside the
      // road.
      const double to_kerb = index.to_kerb(motion.position(t));
      EXPECT_LT(to_kerb, 2.0) << seed << ' ' << t;
      off += to_kerb > -0.5;
      const VehicleState state = motion.state(t);
      EXPECT_LT(state.acceleration_enu.head<2>().norm(), 5.0) << seed << ' ' << t;
      EXPECT_LT(state.rate_body.norm(), 1.2) << seed << ' ' << t;
    }
    EXPECT_LT(off, all / 20) << seed;
    EXPECT_GT(motion.way(120.0) - motion.way(0.0), 500.0) << seed;
  }
}

TEST_F(Karlsruhe, SameSeedSameBytes) {
  SimulationOptions o = options(3);
  o.seconds = 10.0;
  o.sensors = {false, false, true, true};
  expect_same_files(made("karlsruhe", o), made("karlsruhe again", o));
}

TEST_F(Karlsruhe, ARouteFarFromItsRoadsIsRefused) {
  SimulationOptions o = options(1);
  o.route = {{radians(48.0), radians(8.4), 0.0}};
  try {
    choose_site(o);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("place 1 of the route"), std::string::npos);
  }
}

}  // namespace
}  // namespace maploop::simulate
