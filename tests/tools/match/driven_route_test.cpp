// Tests the route of a matched track, and its file.
#include "tools/match/driven_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/track_matching.h"

namespace maploop::match {
namespace {

using maploop::testing::drive;
using maploop::testing::one_way;
using maploop::testing::SmallMap;
using ::testing::ElementsAre;
using ::testing::SizeIs;

// Three streets in a row of 300 m, 40 m and 300 m, and one to the north from each junction.
mapmatch::RoadNetwork row() {
  SmallMap map;
  map.node(1, 0, 0).node(2, 300, 0).node(3, 340, 0).node(4, 640, 0).node(5, 300, 200);
  map.node(6, 340, 200);
  map.way(10, {1, 2}).way(11, {2, 3}).way(12, {3, 4}).way(20, {2, 5}).way(21, {3, 6});
  return map.network();
}

MatchedTrack matched(const mapmatch::RoadNetwork& network, const Track& fixes) {
  static const auto rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  mapmatch::Matcher matcher(network, rules, {});
  MatchedTrack track{fixes, {}};
  for (const auto& fix : fixes) track.results.push_back(matcher.add(fix));
  return track;
}

std::vector<std::int64_t> ways(const DrivenRoute::Piece& piece,
                               const mapmatch::RoadNetwork& network) {
  std::vector<std::int64_t> ways;
  for (const RouteStep& step : piece)
    ways.push_back(network.road_at(network.link(step.link.link).first_vertex).way_id);
  return ways;
}

double length(const DrivenRoute::Piece& piece) {
  double sum = 0.0;
  for (const RouteStep& step : piece) sum += step.length();
  return sum;
}

TEST(DrivenRoute, HasTheLinkBetweenTwoFixesThatNoFixIsOn) {
  const auto network = row();
  // A fix each 100 m.
  const auto track = matched(network, drive({{50, 0}, {640, 0}}, 20.0, 0.2));
  const DrivenRoute route = driven_route(track, network);
  ASSERT_THAT(route.pieces, SizeIs(1));
  EXPECT_THAT(ways(route.pieces[0], network), ElementsAre(10, 11, 12));
  EXPECT_EQ(route.pieces[0][1].fixes, 0U);
  EXPECT_NEAR(route.pieces[0][1].length(), 40.0, 0.1);
  EXPECT_NEAR(to_seconds(route.pieces[0][1].left - route.pieces[0][1].entered), 2.0, 0.3);
}

TEST(DrivenRoute, IsAsLongAsTheDriveAndItsTimesIncrease) {
  const auto network = row();
  const auto track = matched(network, drive({{10, 0}, {630, 0}}, 10.0, 10.0));
  const DrivenRoute route = driven_route(track, network);
  ASSERT_THAT(route.pieces, SizeIs(1));
  EXPECT_NEAR(length(route.pieces[0]), 620.0, 5.0);
  Time before = route.pieces[0][0].entered;
  for (const RouteStep& step : route.pieces[0]) {
    EXPECT_GE(step.entered, before);
    EXPECT_GE(step.left, step.entered);
    EXPECT_GE(step.to, step.from);
    before = step.left;
  }
  ASSERT_TRUE(route.places.back());
  EXPECT_NEAR(route.places.back()->distance, 620.0, 5.0);
}

TEST(DrivenRoute, ABreakAndAFieldBeginANewPiece) {
  const auto network = row();
  auto fixes = drive({{10, 0}, {630, 0}}, 10.0, 10.0);
  for (std::size_t i = 300; i < fixes.size(); ++i) fixes[i].stamp += std::chrono::seconds(100);
  EXPECT_THAT(driven_route(matched(network, fixes), network).pieces, SizeIs(2));
}

TEST(DrivenRoute, OfRareFixesIsOnePiece) {
  const auto network = row();
  const auto rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const mapmatch::MatchParameters parameters;
  const TrackMatching matching{network, rules, parameters};
  const auto track = matching.match(drive({{10, 0}, {630, 0}}, 10.0, 0.05), "rare", nullptr);
  ASSERT_GT(track.second(1), parameters.max_gap);
  const DrivenRoute route = driven_route(track, network);
  ASSERT_THAT(route.pieces, SizeIs(1));
  EXPECT_THAT(ways(route.pieces[0], network), ElementsAre(10, 11, 12));
}

TEST(DrivenRoute, HasNoLegThatNoVehicleCanDrive) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 1000, 0).node(3, 1000, 12).node(4, 0, 12);
  const auto network =
      map.way(10, {1, 2}, one_way()).way(11, {2, 3}).way(12, {3, 4}, one_way()).network();
  // The position hops to the other side of a road that only meets it a kilometre on.
  auto fixes = drive({{10, 0}, {400, 0}}, 10.0, 1.0);
  const auto other = drive({{390, 12}, {10, 12}}, 10.0, 1.0);
  const Duration later = fixes.back().stamp - other.front().stamp + std::chrono::seconds(1);
  for (auto fix : other) {
    fix.stamp += later;
    fixes.push_back(fix);
  }
  const DrivenRoute route = driven_route(matched(network, fixes), network);
  EXPECT_THAT(route.pieces, SizeIs(2));
  for (const DrivenRoute::Piece& piece : route.pieces) EXPECT_LT(length(piece), 700.0);
}

TEST(DrivenRoute, OfNoFixOnARoadIsEmpty) {
  const auto network = row();
  const DrivenRoute route = driven_route(MatchedTrack{}, network);
  EXPECT_TRUE(route.pieces.empty() && route.places.empty());
}

TEST(DrivenRoute, ItsFileHasTheFormOfOsrm) {
  const auto network = row();
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "route.json";
  const auto track = matched(network, drive({{10, 0}, {630, 0}}, 10.0, 1.0));
  write_route(file, track, network);
  const auto json = nlohmann::json::parse(evaluation::read_text(file));
  EXPECT_EQ(json["code"], "Ok");
  ASSERT_EQ(json["tracepoints"].size(), track.fixes.size());
  ASSERT_EQ(json["matchings"].size(), 1U);
  const auto& matching = json["matchings"][0];
  EXPECT_EQ(matching["legs"].size(), track.fixes.size() - 1);
  double legs = 0.0;
  for (const auto& leg : matching["legs"]) legs += leg["distance"].get<double>();
  EXPECT_NEAR(legs, matching["distance"].get<double>(), 0.5);
  EXPECT_EQ(matching["geometry"]["type"], "LineString");
  EXPECT_NEAR(matching["geometry"]["coordinates"][0][1].get<double>(), 49.0, 1e-4);
  EXPECT_EQ(json["tracepoints"][3]["waypoint_index"], 3);
  EXPECT_EQ(matching["ways"][1]["way_id"], 11);
  EXPECT_EQ(matching["ways"][1]["from_node"], 2);
  write_route(file, MatchedTrack{}, network);
  EXPECT_EQ(nlohmann::json::parse(evaluation::read_text(file))["code"], "NoMatch");
}

TEST(DrivenRoute, ItsGeoJsonHasALineForEachLink) {
  const auto network = row();
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "route.geojson";
  write_route_geojson(file, matched(network, drive({{50, 0}, {640, 0}}, 20.0, 0.2)), network);
  const auto features = nlohmann::json::parse(evaluation::read_text(file))["features"];
  ASSERT_EQ(features.size(), 3U);
  EXPECT_EQ(features[1]["properties"]["way_id"], 11);
  EXPECT_EQ(features[1]["geometry"]["coordinates"].size(), 2U);
  EXPECT_EQ(features[0]["geometry"]["coordinates"].back(),
            features[1]["geometry"]["coordinates"].front());
}

TEST(DrivenRoute, ItsGpxIsReadAsATrackWhoseTimesIncrease) {
  const auto network = row();
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "route.gpx";
  const auto track = matched(network, drive({{50, 0}, {640, 0}}, 20.0, 0.2));
  write_route_gpx(file, track, network);
  const Track read = read_track(file, {});
  ASSERT_GE(read.size(), 4U);
  EXPECT_NEAR(read.back().position.longitude, track.fixes.back().position.longitude, 1e-6);
  EXPECT_NEAR(to_seconds(read.back().stamp - track.fixes.back().stamp), 0.0, 1e-3);
  for (std::size_t i = 1; i < read.size(); ++i) EXPECT_GE(read[i].stamp, read[i - 1].stamp);
}

}  // namespace
}  // namespace maploop::match
