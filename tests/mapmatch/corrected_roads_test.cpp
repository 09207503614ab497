// Tests the correction of a map while it becomes tiles.
#include "mapmatch/corrected_roads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapmatch/tiled_map.h"
#include "mapmatch/tiled_map_builder.h"
#include "tests/mapmatch/osm_file.h"
#include "tests/support/real_data.h"

namespace maploop::mapmatch::corrected_roads_test {
namespace {

using maploop::testing::at_place;
using maploop::testing::OsmFile;
using maploop::testing::TemporaryFolder;
using maploop::testing::three_tiles;
using maploop::testing::ways_of;
using ::testing::ElementsAre;

TEST(TiledMapCorrection, IsGivenTheRoadsOfItsTilesAndNoOthers) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  MapExtract given;
  const auto correct = [&](MapExtract& map) {
    given = map;
    map.restrictions.clear();
    map.nodes.push_back({99, 49.02, 8.43});
    MapWay added;
    added.road.way_id = 77;
    added.nodes = {2, 99};
    map.ways.push_back(added);
    map.ways[0].nodes.push_back(99);
  };
  const BuiltTiles built =
      build_tiled_map(three_tiles(folder.path()).road(11, {2, 3, 404}).write(), tiles, {},
                      [](const std::string&) {}, {{tile_at(49.01, 8.41)}, correct});
  EXPECT_THAT(ways_of(given), ElementsAre(10, 11));
  EXPECT_EQ(given.restrictions.size(), 1u);
  EXPECT_EQ(built.table.ways, 4u);
  EXPECT_EQ(built.table.restrictions, 1u);
  EXPECT_EQ(built.missing_nodes, 1u);
  const TiledMap map(tiles);
  const MapExtract whole = map.read();
  EXPECT_THAT(ways_of(whole), ElementsAre(10, 11, 12, 77));
  EXPECT_THAT(whole.ways[0].nodes, ElementsAre(1, 2, 99));
  ASSERT_EQ(whole.restrictions.size(), 1u);
  EXPECT_EQ(whole.restrictions[0].via_node, 4);
  ASSERT_EQ(whole.nodes.size(), 6u);
  EXPECT_NEAR(whole.nodes.back().longitude, 8.43, 1e-9);
  EXPECT_THAT(ways_of(map.read(at_place(49.01, 8.48))), ElementsAre(11))
      << "it is in both of its tiles";
}

TEST(TiledMapCorrection, IsAskedWithoutAnyRoadToo) {
  TemporaryFolder folder;
  int asked = 0;
  build_tiled_map(
      OsmFile(folder.path()).node(1, 49.01, 8.41).node(2, 49.01, 8.42).road(10, {1, 2}).write(),
      folder.path() / "a.tiles", {}, [](const std::string&) {},
      {{tile_at(0.0, 0.0)}, [&](MapExtract& map) { asked += map.ways.empty() ? 1 : 100; }});
  EXPECT_EQ(asked, 1);
}

}  // namespace
}  // namespace maploop::mapmatch::corrected_roads_test
