#include "mapmatch/osm_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "mapmatch/network_file.h"
#include "msgs/frames.h"
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

// The figures of the map come from `osmium cat -f opl karlsruhe... | grep ^w | grep -o
// highway=[a-z_]*`.
TEST(OsmReader, KarlsruheHasTheRoadsThatOsmiumCounts) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const MapExtract map = read_osm(karlsruhe());
  std::map<RoadClass, int> classes;
  for (const MapWay& way : map.ways) ++classes[way.road.road_class];
  EXPECT_EQ(classes[RoadClass::motorway], 26);
  EXPECT_EQ(classes[RoadClass::residential], 442) << "443, and one of them is an area";
  EXPECT_EQ(classes[RoadClass::trunk], 78);
  const RoadNetwork network(build_network(map));
  std::size_t directed = 0;  // the README of the labels lists 23,155 directed segments
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
  EXPECT_THAT(refusal(karlsruhe(), options), ::testing::HasSubstr("no roads inside the box"));
}

TEST(OsmReader, TooLargeIsSaid) {
  MAPLOOP_REQUIRE_REAL_DATA();
  OsmOptions options;
  options.max_nodes = 1000;
  EXPECT_THAT(refusal(karlsruhe(), options), ::testing::HasSubstr("select a part"));
}

TEST(OsmReader, NoMapAndBrokenMapsAreRefusedWithTheirNames) {
  TemporaryFolder folder;
  const auto file = [&](const char* name) { return folder.path() / name; };
  EXPECT_THAT(refusal(file("none.osm.pbf")),
              ::testing::HasSubstr("none.osm.pbf: there is no such"));
  EXPECT_THAT(refusal(folder.path()), ::testing::HasSubstr("not a regular file"));
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

// These functions write the parts of PBF that a map of one road needs.
std::string number(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7U) bytes += static_cast<char>(value | 0x80U);
  return bytes + static_cast<char>(value);
}
std::string field(unsigned tag, std::uint64_t value) {
  return number(tag << 3U) + number(value);
}
std::string field(unsigned tag, const std::string& content) {
  return number(tag << 3U | 2U) + number(content.size()) + content;
}
std::string block(const std::string& kind, const std::string& content) {
  const std::string blob = field(1, content);
  const std::string header = field(1, kind) + field(3, blob.size());
  return std::string(3, '\0') + static_cast<char>(header.size()) + header + blob;
}
std::string zigzag(std::int64_t value) {
  return number(static_cast<std::uint64_t>(value) << 1U ^ static_cast<std::uint64_t>(value >> 63));
}

// Returns a map with two nodes and a way between them that has two tags.
std::string pbf(const std::string& key, const std::string& value) {
  std::string strings, nodes;
  for (const std::string& s :
       {std::string(), std::string("highway"), std::string("primary"), key, value})
    strings += field(1, s);
  for (int i = 1; i <= 2; ++i) {
    const auto place = [&](unsigned tag, std::int64_t units) {
      return number(tag << 3U) + zigzag(units);
    };
    nodes += field(1, place(1, i) + place(8, 490000000 + i * 10000) + place(9, 84000000));
  }
  const std::string way = field(1, 7) + field(2, number(1) + number(3)) +
                          field(3, number(2) + number(4)) + field(8, zigzag(1) + zigzag(1));
  return block("OSMHeader", field(4, std::string("OsmSchema-V0.6"))) +
         block("OSMData", field(1, strings) + field(2, nodes) + field(2, field(3, way)));
}

// libosmium itself would read past the end of the tags of such a way.
TEST(OsmReader, AZeroByteInATagIsRefused) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "small.osm.pbf";
  write(file, pbf("maxspeed", "50"));
  EXPECT_EQ(refusal(file), "");
  for (const auto& [key, value] : {std::pair(std::string("max\0peed", 8), std::string("50")),
                                   std::pair(std::string("maxspeed"), std::string("5\0", 2))}) {
    write(file, pbf(key, value));
    EXPECT_THAT(refusal(file), ::testing::HasSubstr("a tag of way 7 has a zero byte inside"));
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

// The map has left-hand traffic, miles, no names, an area, a road across the 180th meridian, and
// restrictions that are not for cars, over a way, and for cars alone.
TEST(OsmReader, AnotherCountrysMapIsReadAsItIsMeant) {
  TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "taveuni.osm";
  write(file, R"(<osm version="0.6">
    <node id="1" lat="-16.8" lon="179.998"/><node id="2" lat="-16.8" lon="-179.999"/>
    <node id="3" lat="-16.8" lon="-179.996"/><node id="4" lat="-16.801" lon="-179.999"/>
    <node id="5" lat="-16.799" lon="-179.999"/>
    <way id="10"><nd ref="1"/><nd ref="2"/><tag k="highway" v="trunk"/>
      <tag k="driving_side" v="left"/><tag k="maxspeed" v="30 mph"/><tag k="ref" v="1"/></way>
    <way id="11"><nd ref="2"/><nd ref="3"/><tag k="highway" v="residential"/></way>
    <way id="12"><nd ref="2"/><nd ref="4"/><tag k="highway" v="service"/></way>
    <way id="13"><nd ref="2"/><nd ref="5"/><tag k="highway" v="track"/></way>
    <way id="14"><nd ref="3"/><nd ref="4"/><nd ref="5"/><nd ref="3"/>
      <tag k="highway" v="pedestrian"/><tag k="area" v="yes"/></way>
    <relation id="20"><member type="way" ref="14" role="outer"/>
      <tag k="type" v="multipolygon"/><tag k="highway" v="service"/></relation>
    <relation id="21"><member type="way" ref="10" role="from"/><member type="node" ref="2" role="via"/>
      <member type="way" ref="11" role="to"/><tag k="type" v="restriction"/>
      <tag k="restriction" v="no_straight_on"/><tag k="except" v="psv;motorcar"/></relation>
    <relation id="22"><member type="way" ref="10" role="from"/><member type="way" ref="12" role="via"/>
      <member type="way" ref="11" role="to"/><tag k="type" v="restriction"/>
      <tag k="restriction" v="no_u_turn"/></relation>
    <relation id="23"><member type="way" ref="10" role="from"/><member type="node" ref="2" role="via"/>
      <member type="way" ref="12" role="to"/><tag k="type" v="restriction"/>
      <tag k="restriction:motorcar" v="no_left_turn"/></relation>
    <relation id="24"><member type="way" ref="10" role="from"/><member type="node" ref="2" role="via"/>
      <member type="way" ref="13" role="to"/><tag k="type" v="restriction"/>
      <tag k="restriction:hgv" v="no_right_turn"/></relation></osm>)");
  const RoadNetwork network(build_network(read_osm(file)));
  ASSERT_EQ(network.size(), 4U) << "the area is no road";
  double length = 0.0;
  for (std::uint32_t i = 0; i < network.size(); ++i) length += network.link(i).length;
  EXPECT_NEAR(length, 320 + 320 + 111 + 111, 5) << "not once round the earth";
  const Eigen::Vector2d west = network.to_local({radians(-16.8), radians(179.998), 0.0});
  const Eigen::Vector2d east = network.to_local({radians(-16.8), radians(-179.999), 0.0});
  EXPECT_NEAR((east - west).norm(), 319.6, 1.0);
  const Road& trunk = network.data().roads[0];
  EXPECT_EQ(trunk.name, "1") << "its number, for it has no name";
  EXPECT_NEAR(trunk.speed_limit, 30 * 0.44704, 1e-9);
  EXPECT_TRUE(network.data().roads[1].name.empty());
  ASSERT_EQ(network.data().banned.size(), 1U);
  EXPECT_EQ(network.road_at(network.link(network.data().banned[0].to.link).first_vertex).way_id,
            12);
  ASSERT_EQ(network.data().warnings.size(), 1U);
  EXPECT_EQ(network.data().warnings[0], "1 turn restrictions via a way are left out");
}

TEST(OsmReader, AMapThatIsTooWideForOnePlaneIsWarnedOf) {
  MapExtract map;
  map.nodes = {{1, 40.0, -100.0}, {2, 40.0, -99.99}, {3, 40.0, -85.0}, {4, 40.0, -84.99}};
  map.ways = {{Road{}, {1, 2}}, {Road{}, {3, 4}}};
  const NetworkData network = build_network(map);
  ASSERT_EQ(network.warnings.size(), 1U);
  EXPECT_THAT(network.warnings[0], ::testing::HasSubstr("640 km from its middle"));
}

}  // namespace
}  // namespace maploop::mapmatch
