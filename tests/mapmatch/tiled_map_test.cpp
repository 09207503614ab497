#include "mapmatch/tiled_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "mapmatch/map_area.h"
#include "mapmatch/network_file.h"
#include "mapmatch/tiled_map_builder.h"
#include "msgs/archive.h"
#include "msgs/frames.h"
#include "tests/mapmatch/osm_file.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::mapmatch::tiled_map_test {
namespace {

using maploop::testing::at_place;
using maploop::testing::error_of;
using maploop::testing::OsmFile;
using maploop::testing::real_data;
using maploop::testing::TemporaryFolder;
using maploop::testing::three_tiles;
using maploop::testing::ways_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path karlsruhe() {
  return real_data() / "maps" / "karlsruhe_2012-04.osm.pbf";
}

TEST(TiledMap, AllTilesTogetherAreTheWholeMap) {
  MAPLOOP_REQUIRE_REAL_DATA();
  TemporaryFolder folder;
  const auto tiles = folder.path() / "karlsruhe.tiles";
  const BuiltTiles built = build_tiled_map(karlsruhe(), tiles);
  EXPECT_EQ(built.table.ways, 1881u);
  EXPECT_EQ(built.table.tiles.size(), 12u);
  const auto bytes = [](const std::filesystem::path& file) {
    NetworkData network = open_network(file);
    network.warnings.clear();  // restrictions outside of all tiles are left out of them
    ArchiveWriter writer;
    writer(network);
    return writer.take();
  };
  EXPECT_TRUE(bytes(tiles) == bytes(karlsruhe()));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "the work's own files are left behind";
}

TEST(TiledMap, ABoxHasTheRoadsOfItsTilesWhole) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  build_tiled_map(three_tiles(folder.path()).road(11, {2, 3}).write(), tiles);
  const TiledMap map(tiles);
  EXPECT_THAT(ways_of(map.read(at_place(49.01, 8.41))), ElementsAre(10, 11));
  EXPECT_EQ(map.read(at_place(49.01, 8.41)).nodes.size(), 3u) << "11 is whole";
  EXPECT_EQ(map.read(at_place(49.01, 8.41)).restrictions.size(), 1u);
  EXPECT_THAT(ways_of(map.read(at_place(49.01, 8.48))), ElementsAre(11));
  EXPECT_THAT(ways_of(map.read({8.41, 49.01, 8.41, 49.11})), ElementsAre(10, 11, 12));
  EXPECT_THAT(ways_of(map.read(at_place(49.5, 8.41))), ElementsAre());
  EXPECT_NEAR(map.area().south, 49.0, 1e-9);
  EXPECT_NEAR(map.area().north, 49.15, 1e-9);
  EXPECT_THAT(error_of([&] { (void)map.read(GeographicBox{}, 4); }),
              HasSubstr("more than 4 nodes"));
}

TEST(TiledMap, ASegmentIsInTheTilesThatItCrosses) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  build_tiled_map(
      OsmFile(folder.path()).node(1, 49.01, 8.41).node(2, 49.01, 8.61).road(10, {1, 2}).write(),
      tiles);
  EXPECT_THAT(ways_of(TiledMap(tiles).read(at_place(49.02, 8.52))), ElementsAre(10));
  EXPECT_EQ(TiledMap(tiles).table().tiles.size(), 5u);
}

TEST(TiledMap, ABoxMayContainThe180thMeridian) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  build_tiled_map(OsmFile(folder.path())
                      .node(1, -17.0, 179.98)
                      .node(2, -17.0, -179.98)
                      .node(3, -17.0, 0.0)
                      .node(4, -17.0, 0.01)
                      .road(10, {1, 2})
                      .road(11, {3, 4})
                      .write(),
                  tiles);
  const TiledMap map(tiles);
  const MapExtract near = map.read(around({radians(-17.0), radians(179.99), 0.0}, 4000.0));
  EXPECT_THAT(ways_of(near), ElementsAre(10));
  EXPECT_NEAR(RoadNetwork(build_network(near)).link(0).length, 4258.0, 20.0);
}

TEST(TiledMap, APlaceOutsideOfTheEarthIsInATileOfItsEdge) {
  EXPECT_EQ(tile_at(1e300, -1e300), (TilePlace{3599, 0}));
  EXPECT_EQ(tile_at(-91.0, 180.0), (TilePlace{0, 7199}));
  EXPECT_EQ(tile_at(std::nan(""), std::nan("")), (TilePlace{0, 0}));
}

TEST(TiledMap, ATableThatNobodyWroteIsRefused) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.tiles";
  const auto error = [&](const std::vector<TileEntry>& tiles) {
    TileTable table;
    table.tiles = tiles;
    const Bytes content = sealed(table);
    std::ofstream out(file, std::ios::binary);
    const Bytes head = sealed(TiledMapHead{sealed(TiledMapHead{}).size(), content.size()});
    for (const Bytes& part : {head, content}) {
      out.write(reinterpret_cast<const char*>(part.data()),
                static_cast<std::streamsize>(part.size()));
    }
    out.close();
    return error_of([&] { (void)TiledMap(file).area(); });
  };
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(error({{{1, 1}, 100, 10}, {{1, 2}, 110, 10}}), "");
  EXPECT_THAT(error({{{most, 1}, 100, 10}}), HasSubstr("a tile is not on the Earth"));
  EXPECT_THAT(error({{{1, -1}, 100, 10}}), HasSubstr("a tile is not on the Earth"));
  EXPECT_THAT(error({{{1, 1}, 100, 10}, {{1, 1}, 110, 10}}), HasSubstr("not in order"));
  EXPECT_THAT(error({{{1, 1}, 100, 10}, {{1, 2}, 105, 10}}), HasSubstr("not in order"));
  EXPECT_THAT(error({{{1, 1}, 100, std::uint64_t{1} << 40U}}), HasSubstr("size of a tile"));
}

TEST(TiledMap, ANodeThatTheMapLacksCutsItsRoad) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  const auto small = OsmFile(folder.path())
                         .node(1, 49.01, 8.41)
                         .node(2, 49.011, 8.41)
                         .node(4, 49.013, 8.41)
                         .node(5, 49.014, 8.41)
                         .road(10, {1, 2, 3, 4, 5})
                         .road(11, {8, 9})
                         .write();
  EXPECT_EQ(build_tiled_map(small, tiles).missing_nodes, 1u);
  EXPECT_EQ(RoadNetwork(open_network(tiles)).size(), 2u);
}

TEST(TiledMap, ADamagedTileIsNamedAndTheOthersAreRead) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  build_tiled_map(OsmFile(folder.path())
                      .node(1, 49.01, 8.41)
                      .node(2, 49.02, 8.41)
                      .node(3, 49.11, 8.41)
                      .node(4, 49.12, 8.41)
                      .road(10, {1, 2})
                      .road(11, {3, 4})
                      .write(),
                  tiles);
  {
    const TileEntry second = TiledMap(tiles).table().tiles.at(1);
    std::fstream file(tiles, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(second.offset + second.size - 1));
    file.put('x');
  }
  const TiledMap map(tiles);
  EXPECT_THAT(ways_of(map.read(at_place(49.01, 8.41))), ElementsAre(10));
  const std::string error = error_of([&] { (void)map.read(at_place(49.11, 8.41)); });
  EXPECT_THAT(error, HasSubstr("a.tiles: the tile at 49.1"));
  EXPECT_THAT(error, HasSubstr("it is damaged: its checksum does not fit"));
}

TEST(TiledMap, ADamagedCutOrForeignFileIsRefused) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  build_tiled_map(
      OsmFile(folder.path()).node(1, 49.01, 8.41).node(2, 49.02, 8.41).road(10, {1, 2}).write(),
      tiles);
  std::ifstream in(tiles, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto with = [&](const std::string& content) {
    std::ofstream(tiles, std::ios::binary) << content;
    return error_of([&] { (void)TiledMap(tiles).read(); });
  };
  EXPECT_EQ(with(whole), "");
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    EXPECT_THAT(with(flipped), HasSubstr("a.tiles")) << at;
    EXPECT_THAT(with(whole.substr(0, at)), HasSubstr("a.tiles")) << at;
  }
  EXPECT_THAT(with(whole + "x"), HasSubstr("joined to another"));
  EXPECT_FALSE(is_tiled_map(folder.path()));
  EXPECT_FALSE(is_tiled_map(folder.path() / "small.osm"));
  EXPECT_THAT(error_of([&] { TiledMap(folder.path() / "none"); }), HasSubstr("none"));
}

TEST(TiledMap, ALinkStaysAndAPipeIsNotReplaced) {
  TemporaryFolder folder;
  const auto map =
      OsmFile(folder.path()).node(1, 49.01, 8.41).node(2, 49.02, 8.41).road(10, {1, 2}).write();
  std::ofstream(folder.path() / "a.tiles") << "old";
  std::filesystem::create_symlink("a.tiles", folder.path() / "link.tiles");
  build_tiled_map(map, folder.path() / "link.tiles");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.tiles"));
  EXPECT_THAT(ways_of(TiledMap(folder.path() / "a.tiles").read()), ElementsAre(10));
  const auto pipe = folder.path() / "pipe.tiles";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { build_tiled_map(map, pipe); }), HasSubstr("not a regular file"));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(TiledMap, WhatCannotBeBuiltIsRefusedWithoutAFile) {
  TemporaryFolder folder;
  const auto tiles = folder.path() / "a.tiles";
  const auto error = [&](const std::filesystem::path& map, const OsmOptions& options = {}) {
    return error_of([&] { build_tiled_map(map, tiles, options); });
  };
  EXPECT_THAT(error(folder.path() / "none.osm"), HasSubstr("none.osm: there is no such file"));
  const auto nodes = OsmFile(folder.path()).node(1, 49.0, 8.4).write();
  EXPECT_THAT(error(nodes), HasSubstr("it has no roads"));
  OsmOptions options;
  options.max_nodes = 1;
  const auto small =
      OsmFile(folder.path()).node(1, 49.01, 8.41).node(2, 49.02, 8.41).road(10, {1, 2}).write();
  EXPECT_THAT(error(small, options), HasSubstr("more than 1 nodes"));
  options = {.box = GeographicBox{0.0, 0.0, 1.0, 1.0}};
  EXPECT_THAT(error(small, options), HasSubstr("no roads inside the box"));
  EXPECT_THAT(error_of([&] { build_tiled_map(small, folder.path() / "no/folder.tiles"); }),
              HasSubstr("cannot write"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace maploop::mapmatch::tiled_map_test
