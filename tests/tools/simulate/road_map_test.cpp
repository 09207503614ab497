// Tests the map that the matcher gets of a simulated town.
#include "tools/simulate/town/road_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "mapmatch/osm_reader.h"
#include "msgs/frames.h"
#include "tests/support/real_data.h"
#include "tools/simulate/town/route.h"

namespace maploop::simulate {
namespace {

const LocalFrame frame({radians(49.0), radians(8.4), 100.0});

using Nodes = std::map<std::int64_t, Eigen::Vector2d>;

Nodes nodes_of(const mapmatch::MapExtract& map) {
  Nodes nodes;
  for (const mapmatch::MapNode& node : map.nodes)
    nodes[node.id] = frame.to_enu({radians(node.latitude), radians(node.longitude), 0.0}).head<2>();
  return nodes;
}

mapmatch::MapExtract written(const Streets& streets, std::uint64_t seed, const MapErrors& errors) {
  const maploop::testing::TemporaryFolder folder;
  write_road_map(folder.path() / "map.osm", streets, frame, seed, errors);
  return mapmatch::read_osm(folder.path() / "map.osm");
}

TEST(SimulatedRoadMap, IsOffByTheErrorsAsked) {
  double squares = 0.0, count = 0.0, wrong = 0.0, streets = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Streets town = make_town(seed);
    const auto exact = written(town, seed, {0.0, 300.0, 0.0});
    const auto usual = written(town, seed, {});
    EXPECT_EQ(exact.ways.size(), town.streets.size());
    const Nodes true_nodes = nodes_of(exact);
    for (const auto& [id, place] : nodes_of(usual)) {
      squares += (place - true_nodes.at(id)).squaredNorm();
      count += 1.0;
    }
    std::size_t oneway = 0, extra = 0;
    for (const mapmatch::MapWay& way : usual.ways) {
      oneway += way.road.forward != way.road.backward ? 1U : 0U;
      extra += way.road.way_id >= 15'000 ? 1U : 0U;
    }
    const std::size_t missing = town.streets.size() - (usual.ways.size() - extra);
    wrong += static_cast<double>(missing + oneway + extra);
    streets += static_cast<double>(town.streets.size());
  }
  EXPECT_NEAR(std::sqrt(squares / count), 2.0, 0.3);
  EXPECT_NEAR(wrong / streets, 0.05, 0.02);
}

TEST(SimulatedRoadMap, LabelsNameTheSegmentsDriven) {
  const Streets town = make_town(1);
  const auto route = make_route(town, nearest_junction(town, {0, 0}), longest_drive(30.0), 1);
  const auto path = std::make_shared<LanePath>(town, route, 1);
  const VehicleMotion motion(path, std::make_shared<SpeedProfile>(*path, town, 30.0, 1), Terrain(1),
                             1);
  std::vector<double> times;
  for (double t = 0.0; t < 30.0; t += 0.1) times.push_back(t);
  const maploop::testing::TemporaryFolder folder;
  write_driven_links(folder.path() / "links.csv", town, motion, times);
  const Nodes nodes = nodes_of(written(town, 1, {0.0, 300.0, 0.0}));
  std::ifstream links(folder.path() / "links.csv");
  std::string line;
  std::getline(links, line);
  EXPECT_EQ(line, "frame,way_id,node_a,node_b,conf");
  std::size_t rows = 0, certain = 0;
  for (; std::getline(links, line); ++rows) {
    std::istringstream text(line);
    std::size_t row = 0;
    std::int64_t way = 0, a = 0, b = 0;
    int sure = 0;
    char comma = 0;
    text >> row >> comma >> way >> comma >> a >> comma >> b >> comma >> sure;
    ASSERT_EQ(row, rows);
    certain += sure;
    if (!sure) continue;
    const Eigen::Vector2d from = nodes.at(a), segment = nodes.at(b) - from;
    const Eigen::Vector2d place = motion.position(times[row]) - from;
    const double along = place.dot(segment.normalized());
    const double right =
        place.x() * segment.normalized().y() - place.y() * segment.normalized().x();
    // The segment is driven from a to b, in the right lane or a metre to its left. (The labels
    // interpolate the way by lengths, so that they may be a few metres off.)
    EXPECT_GT(right, -0.5) << line;
    EXPECT_LT(right, 4.0) << line;
    EXPECT_GT(along, -6.0) << line;
    EXPECT_LT(along, segment.norm() + 6.0) << line;
  }
  EXPECT_EQ(rows, times.size());
  EXPECT_GT(certain, rows / 4);  // the car waits before junctions
}

}  // namespace
}  // namespace maploop::simulate
