#include "mapmatch/osm_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "mapmatch/network_file.h"
#include "tests/support/real_data.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::real_data;
using maploop::testing::TemporaryFolder;

std::filesystem::path karlsruhe() {
  return real_data() / "maps" / "karlsruhe_2012-04.osm.pbf";
}

std::string refusal(const std::filesystem::path& file, const OsmOptions& options = {}) {
  try {
    read_osm(file, options);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The figures of the map are `osmium cat -f opl karlsruhe... | grep ^w | grep -o highway=[a-z_]*`.
TEST(OsmReader, KarlsruheHasTheRoadsThatOsmiumCounts) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const MapExtract map = read_osm(karlsruhe());
  std::map<RoadClass, int> classes;
  for (const MapWay& way : map.ways) ++classes[way.road.road_class];
  EXPECT_EQ(classes[RoadClass::motorway], 26);
  EXPECT_EQ(classes[RoadClass::residential], 442) << "443, and one of them is an area";
  EXPECT_EQ(classes[RoadClass::trunk], 78);
  const RoadNetwork network(build_network(map));
  std::size_t directed = 0;  // the labels' README counts 23,155 directed segments
  for (std::uint32_t i = 0; i < network.size(); ++i)
    for (const bool forward : {true, false})
      if (network.allowed({i, forward})) directed += network.link(i).vertex_count - 1;
  EXPECT_NEAR(static_cast<double>(directed), 23155.0, 500.0);
  EXPECT_GT(network.data().banned.size(), 20u);
}

TEST(OsmReader, EverySegmentThatWasDrivenIsOnALinkAndInOneConnectedWay) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const RoadNetwork network(build_network(read_osm(karlsruhe())));
  std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> segments;
  for (std::uint32_t i = 0; i < network.size(); ++i) {
    const Link& l = network.link(i);
    for (std::uint32_t v = l.first_vertex; v + 1 < l.first_vertex + l.vertex_count; ++v) {
      const auto [a, b] = network.nodes({i, true}, v);
      if (l.forward) segments.insert({network.road_at(v).way_id, a, b});
      if (l.backward) segments.insert({network.road_at(v).way_id, b, a});
    }
  }
  int checked = 0;
  for (const char* sequence : {"00", "01", "02", "03", "04", "06", "08", "10"}) {
    std::ifstream route(real_data() / "kitti_odometry/labels" /
                        (std::string(sequence) + ".route.csv"));
    std::string line;
    std::getline(route, line);
    while (std::getline(route, line)) {
      long long order = 0, way = 0, a = 0, b = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "%lld,%lld,%lld,%lld", &order, &way, &a, &b), 4);
      EXPECT_TRUE(segments.contains({way, a, b})) << sequence << ": " << line;
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(OsmReader, ABoxTakesAPart) {
  MAPLOOP_REQUIRE_REAL_DATA();
  OsmOptions options;
  options.box = {8.38, 48.97, 8.41, 48.99};
  const MapExtract part = read_osm(karlsruhe(), options);
  EXPECT_GT(part.ways.size(), 50u);
  EXPECT_LT(part.ways.size(), read_osm(karlsruhe()).ways.size() / 2);
  for (const MapNode& n : part.nodes) {
    EXPECT_GE(n.longitude, 8.38);
    EXPECT_LE(n.latitude, 48.99);
  }
  options.box = {0.0, 0.0, 1.0, 1.0};
  EXPECT_THAT(refusal(karlsruhe(), options), ::testing::HasSubstr("no road inside the box"));
}

TEST(OsmReader, TooLargeIsSaid) {
  MAPLOOP_REQUIRE_REAL_DATA();
  OsmOptions options;
  options.max_nodes = 1000;
  EXPECT_THAT(refusal(karlsruhe(), options), ::testing::HasSubstr("choose a part"));
}

TEST(OsmReader, NoMapAndBrokenMapsAreRefusedWithTheirNames) {
  TemporaryFolder folder;
  const auto file = [&](const char* name) { return folder.path() / name; };
  EXPECT_THAT(refusal(file("none.osm.pbf")),
              ::testing::HasSubstr("none.osm.pbf: there is no such"));
  EXPECT_THAT(refusal(folder.path()), ::testing::HasSubstr("no regular file"));
  write(file("empty.osm.pbf"), "");
  EXPECT_THAT(refusal(file("empty.osm.pbf")), ::testing::HasSubstr("empty"));
  write(file("text.osm.pbf"), "this is no map, and says so at some length");
  EXPECT_NE(refusal(file("text.osm.pbf")), "");
  write(file("map.txt"), "x");
  EXPECT_THAT(refusal(file("map.txt")), ::testing::HasSubstr("expected: .osm.pbf"));
  write(file("open.osm"), "<osm version=\"0.6\"><node id=\"1\" lat=\"49\"");
  EXPECT_NE(refusal(file("open.osm")), "");
  write(file("roadless.osm"), "<osm version=\"0.6\"></osm>");
  EXPECT_THAT(refusal(file("roadless.osm")), ::testing::HasSubstr("it has no road"));
}

TEST(OsmReader, ACutOrDamagedMapIsRefusedOrReadAndNeverCrashes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "broken.osm.pbf";
  const std::string whole = read(real_data() / "maps" / "karlsruhe_00_road_missing.osm.pbf");
  for (const double share : {0.001, 0.3, 0.8, 0.9999}) {
    write(file,
          whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_NE(refusal(file), "") << share;
  }
  for (std::size_t at = 3; at < whole.size(); at += whole.size() / 23) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x5a);
    write(file, flipped);
    refusal(file);
  }
}

TEST(OsmReader, PlainXmlIsReadToo) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "small.osm";
  write(file,
        "<osm version=\"0.6\"><node id=\"1\" lat=\"49\" lon=\"8\"/><node id=\"2\" lat=\"49.001\" "
        "lon=\"8\"/><way id=\"7\"><nd ref=\"1\"/><nd ref=\"2\"/><tag k=\"highway\" "
        "v=\"living_street\"/><tag k=\"name\" v=\"Am See\"/></way></osm>");
  const RoadNetwork network(open_network(file));
  ASSERT_EQ(network.size(), 1u);
  EXPECT_EQ(network.road_at(0).name, "Am See");
  EXPECT_NEAR(network.link(0).length, 111.2, 0.1);
}

}  // namespace
}  // namespace maploop::mapmatch
