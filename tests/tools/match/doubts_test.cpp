// Tests doubts of several drives: what is joined, what is written and read, and what is corrected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mapmatch/matcher.h"
#include "mapmatch/network_file.h"
#include "msgs/frames.h"
#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/doubts_file.h"
#include "tools/match/map_corrections.h"
#include "tools/match/match_score.h"

namespace maploop::match {
namespace {

using maploop::testing::one_way;
using maploop::testing::SmallMap;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A street of 1 km from west to east, and a street across its middle to the north, at whose end is
// a parallel one that only the street in between joins.
SmallMap ladder(bool with_rung, const mapmatch::Road& rung = {}) {
  SmallMap map;
  map.node(1, -500, 0).node(2, 0, 0).node(3, 500, 0);
  map.node(4, -500, 600).node(5, 0, 600).node(6, 500, 600);
  map.way(10, {1, 2, 3}).way(30, {4, 5, 6});
  if (with_rung) map.way(20, {2, 5}, rung);
  return map;
}

const Track& up_the_rung() {
  static const Track track =
      maploop::testing::drive({{-490, 0}, {0, 0}, {0, 600}, {490, 600}}, 10.0, 10.0);
  return track;
}

const mapmatch::RuleBases& the_rules() {
  static const auto bases = mapmatch::read_rule_bases(mapmatch::default_rules());
  return bases;
}

std::vector<MapDoubt> found(const mapmatch::RoadNetwork& network, const Track& track) {
  mapmatch::Matcher matcher(network, the_rules(), {});
  std::vector<MapDoubt> doubts;
  match_track(matcher, track, {.doubts = &doubts});
  return doubts;
}

std::vector<PooledDoubt> pooled(const mapmatch::RoadNetwork& network,
                                const std::vector<Track>& tracks) {
  DoubtPool pool(network);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (const MapDoubt& doubt : found(network, tracks[i]))
      pool.add(doubt, "drive " + std::to_string(i));
  }
  return pool.likelier_than(0.5);
}

TEST(DoubtPool, JoinsWhatTwoDrivesSayOfTheSameGround) {
  const auto network = ladder(false).network();
  const auto doubts = pooled(network, {up_the_rung(), up_the_rung()});
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_EQ(doubts[0].times, 2U) << "twice, by the two drives";
  EXPECT_THAT(doubts[0].drives, SizeIs(2));
  const auto once = pooled(network, {up_the_rung()});
  ASSERT_THAT(once, SizeIs(1));
  EXPECT_GT(doubts[0].doubt.probability, once[0].doubt.probability);
}

TEST(DoubtPool, KeepsTwoRoadsApart) {
  const auto network = ladder(false).network();
  const auto elsewhere =
      maploop::testing::drive({{-490, 0}, {200, 0}, {200, 600}, {490, 600}}, 10.0, 10.0);
  EXPECT_THAT(pooled(network, {up_the_rung(), elsewhere}), SizeIs(2));
}

// A doubt of a missing road, with a point each 10 m to the north.
MapDoubt missing(double east, double south, double north, double probability) {
  MapDoubt doubt;
  doubt.probability = probability;
  doubt.length = north - south;
  const double step = std::max(10.0, doubt.length / (MapDoubt::max_points - 1));
  for (double at = south; at <= north && doubt.track_count < MapDoubt::max_points; at += step)
    doubt.track[doubt.track_count++] = SmallMap::place(east, at);
  return doubt;
}

TEST(DoubtPool, KeepsTheLongestTrackOfARoadInAnyOrder) {
  const auto network = ladder(false).network();
  for (const bool long_first : {true, false}) {
    DoubtPool pool(network);
    if (long_first) pool.add(missing(0, 0, 3000, 0.97), "a");
    pool.add(missing(0, 0, 1000, 0.98), "b");
    if (!long_first) pool.add(missing(0, 0, 3000, 0.97), "a");
    const auto found = pool.likelier_than(0.5);
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].doubt.length, 3000.0);
    EXPECT_NEAR(found[0].doubt.probability, 1.0 - 0.02 * 0.03, 1e-12);
  }
}

TEST(DoubtPool, WhatOneDriveSaysTwiceIsNoMoreLikely) {
  const auto network = ladder(false).network();
  DoubtPool twice(network);
  for (int i = 0; i < 2; ++i) twice.add(missing(0, 0, 500, 0.6), "a");
  EXPECT_NEAR(twice.likelier_than(0.5).at(0).doubt.probability, 0.6, 1e-12);
}

TEST(DoubtPool, ManyUnlikelyDoubtsProveNothing) {
  const auto network = ladder(false).network();
  DoubtPool pool(network);
  for (int i = 0; i < 20; ++i) pool.add(missing(0, 0, 500, 0.2), "drive " + std::to_string(i));
  EXPECT_THAT(pool.likelier_than(0.5), IsEmpty());
}

// Positions of 3 m do not show a shift of 8 m, five drives of them do.
TEST(DoubtPool, OffsetsOfManyDrivesShowAShift) {
  const auto network = ladder(true).network();
  Track beside = maploop::testing::drive({{-490, 0}, {490, 0}}, 10.0, 10.0, 8.0);
  for (auto& fix : beside) fix.covariance = 9.0 * Eigen::Matrix2d::Identity();
  Track back = maploop::testing::drive({{490, 0}, {-490, 0}}, 10.0, 10.0, -8.0);
  for (auto& fix : back) fix.covariance = 9.0 * Eigen::Matrix2d::Identity();
  EXPECT_THAT(pooled(network, {beside}), IsEmpty());
  const auto doubts = pooled(network, {beside, back, beside, back, beside});
  ASSERT_THAT(doubts, SizeIs(2)) << "of the links on either side of the junction";
  EXPECT_EQ(doubts[0].doubt.kind, DoubtKind::shifted_road);
  EXPECT_NEAR(std::abs(doubts[0].doubt.offset), 8.0, 0.5);
  EXPECT_NEAR(doubts[0].doubt.offset_sigma, 3.0 / std::sqrt(5.0), 0.01);
}

class DoubtsFile : public ::testing::Test {
 public:
  std::string error_of(const std::string& text) const {
    evaluation::write_text(file, text);
    return maploop::testing::error_of([&] { read_doubts(file, 0.0); });
  }

  maploop::testing::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "doubts.geojson";
};

TEST_F(DoubtsFile, ComesBackWithWhatCorrectsAMap) {
  const auto network = ladder(false).network();
  const auto doubts = pooled(network, {up_the_rung()});
  write_doubts(file, doubts, network);
  const auto read = read_doubts(file, 0.5);
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_EQ(read[0].kind, DoubtKind::missing_road);
  EXPECT_EQ(read[0].from.way_id, 10);
  EXPECT_EQ(read[0].to.way_id, 30);
  ASSERT_EQ(read[0].track_count, doubts[0].doubt.track_count);
  EXPECT_NEAR(read[0].track[3].latitude, doubts[0].doubt.track[3].latitude, 1e-12);
  EXPECT_THAT(read_doubts(file, 0.99999), IsEmpty());
}

TEST_F(DoubtsFile, ErrorsNameTheFileAndWhatIsWrong) {
  EXPECT_THAT(error_of("{}"), HasSubstr("doubts.geojson"));
  EXPECT_THAT(error_of("not JSON"), HasSubstr("not a file of 'maploop map doubts'"));
  EXPECT_THAT(error_of(R"({"features": [{"properties": {"kind": "hole"}}]})"),
              AllOf(HasSubstr("there is no kind 'hole'"), HasSubstr("doubts.geojson")));
  EXPECT_THAT(error_of(R"({"features": [{"properties": {"kind": "missing road"}}]})"),
              HasSubstr("probability"));
}

TEST_F(DoubtsFile, PlacesOffTheEarthAndIdsThatAreNoneAreRefused) {
  const auto network = ladder(false).network();
  write_doubts(file, pooled(network, {up_the_rung()}), network);
  const std::string good = evaluation::read_text(file);
  const auto with = [&](const std::string& key, const std::string& value) {
    auto parsed = nlohmann::json::parse(good);
    auto& feature = parsed["features"][0];
    if (key == "point") {
      feature["geometry"]["coordinates"][0] = nlohmann::json::parse(value);
    } else {
      feature["properties"][key] = nlohmann::json::parse(value);
    }
    return error_of(parsed.dump());
  };
  EXPECT_EQ(error_of(good), "");
  EXPECT_THAT(with("point", "[8.4, 4900]"), HasSubstr("in degrees"));
  EXPECT_THAT(with("point", "[8.4]"), HasSubstr("doubts.geojson"));
  EXPECT_THAT(with("way", "1.5"), HasSubstr("not a whole number"));
  EXPECT_THAT(with("to_node_a", "1e300"), HasSubstr("not a whole number"));
}

TEST_F(DoubtsFile, AWrongDirectionIsThatOfAllWaysOfItsLink) {
  SmallMap map;
  map.node(1, 0, 0).node(2, 0, 300).node(3, 0, 600).node(4, 500, 0);
  map.way(10, {1, 2}, one_way()).way(11, {2, 3}, one_way()).way(20, {1, 4});
  const auto network = map.network();
  const Track down = maploop::testing::drive({{0, 590}, {0, 0}, {490, 0}}, 10.0, 10.0);
  write_doubts(file, pooled(network, {down}), network);
  mapmatch::MapExtract extract = map.extract();
  EXPECT_EQ(correct(extract, read_doubts(file, 0.5)).directions, 2U);
  for (const mapmatch::MapWay& way : extract.ways) EXPECT_TRUE(way.road.backward);
}

TEST(MapCorrections, ARoadThatWasMissingJoinsItsNeighboursAndIsDrivenFromThenOn) {
  const auto doubts = found(ladder(false).network(), up_the_rung());
  mapmatch::MapExtract map = ladder(false).extract();
  const Corrections done = correct(map, doubts);
  EXPECT_EQ(done.roads, 1U);
  const mapmatch::RoadNetwork network(mapmatch::build_network(map));
  EXPECT_THAT(pooled(network, {up_the_rung()}), IsEmpty());
  mapmatch::Matcher matcher(network, the_rules(), {});
  for (const MatchedFix& fix : match_track(matcher, up_the_rung())) EXPECT_TRUE(fix.way_id);
}

TEST(MapCorrections, ADirectionThatWasDrivenIsOpen) {
  mapmatch::Road down = one_way();
  std::swap(down.forward, down.backward);
  mapmatch::MapExtract map = ladder(true, down).extract();
  const auto doubts = pooled(ladder(true, down).network(), {up_the_rung()});
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_EQ(correct(map, {doubts[0].doubt}).directions, 1U);
  EXPECT_THAT(pooled(mapmatch::RoadNetwork(mapmatch::build_network(map)), {up_the_rung()}),
              IsEmpty());
}

TEST(MapCorrections, ATurnThatWasDrivenIsAllowed) {
  SmallMap banned = ladder(true);
  banned.ban(10, 2, 20);
  const auto doubts = pooled(banned.network(), {up_the_rung()});
  ASSERT_THAT(doubts, SizeIs(1));
  mapmatch::MapExtract map = banned.extract();
  EXPECT_EQ(correct(map, {doubts[0].doubt}).turns, 1U);
  EXPECT_THAT(map.restrictions, IsEmpty());
}

TEST(MapCorrections, ATurnAtAnotherJunctionStaysForbidden) {
  SmallMap banned = ladder(true);
  banned.ban(10, 2, 20).ban(10, 1, 20);
  const auto doubts = pooled(banned.network(), {up_the_rung()});
  ASSERT_THAT(doubts, SizeIs(1));
  mapmatch::MapExtract map = banned.extract();
  correct(map, {doubts[0].doubt});
  ASSERT_THAT(map.restrictions, SizeIs(1));
  EXPECT_EQ(map.restrictions[0].via_node, 1);
}

TEST(MapCorrections, ARoadThatTheMapHasByNowOrThatJoinsNothingIsLeft) {
  const auto likely = pooled(ladder(false).network(), {up_the_rung()});
  ASSERT_THAT(likely, SizeIs(1));
  const std::vector<MapDoubt> doubts{likely[0].doubt};
  mapmatch::MapExtract newer = ladder(true).extract();
  EXPECT_EQ(correct(newer, doubts).left, 1U);
  EXPECT_EQ(newer.ways.size(), 3U);
  mapmatch::MapExtract elsewhere = ladder(false).extract();
  for (mapmatch::MapWay& way : elsewhere.ways) way.road.way_id += 1000;
  const std::size_t nodes = elsewhere.nodes.size();
  EXPECT_EQ(correct(elsewhere, doubts).left, 1U);
  EXPECT_EQ(elsewhere.nodes.size(), nodes);
}

TEST(MapCorrections, NeedTheTilesWithin100MetresOfTheirTracks) {
  MapDoubt doubt;
  doubt.track[0] = {radians(49.025), radians(8.425), 0.0};
  doubt.track[1] = {radians(49.025), radians(8.449), 0.0};  // 70 m from the next tile
  doubt.track_count = 2;
  EXPECT_THAT(places_of({doubt}), ::testing::ElementsAre(mapmatch::tile_at(49.025, 8.425),
                                                         mapmatch::tile_at(49.025, 8.451)));
  EXPECT_THAT(places_of({}), IsEmpty());
}

TEST(MapCorrections, WhatTheMapHasNoLongerIsLeftAndCounted) {
  MapDoubt shifted, gone, turn;
  shifted.kind = DoubtKind::shifted_road;
  gone.kind = DoubtKind::wrong_direction;
  gone.from.way_id = 4711;
  turn.kind = DoubtKind::forbidden_turn;
  mapmatch::MapExtract map = ladder(true).extract();
  const Corrections done = correct(map, {shifted, gone, turn, MapDoubt{}});
  EXPECT_EQ(done.left, 4U);
  EXPECT_EQ(map.ways.size(), 3U);
}

}  // namespace
}  // namespace maploop::match
