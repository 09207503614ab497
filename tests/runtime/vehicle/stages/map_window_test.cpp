#include "runtime/vehicle/stages/map_window.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "mapmatch/map_area.h"
#include "mapmatch/tiled_map_builder.h"
#include "msgs/frames.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle::map_window_test {
namespace {

using maploop::testing::TemporaryFolder;
using std::chrono::milliseconds;
using testing::Drive;
using testing::drive;
using testing::drive_start;
using testing::Driven;
using testing::fake_sensors;

constexpr double metre = 1.0 / 111'200.0;  // degrees of latitude

Geodetic north_of_start(double metres) {
  return {radians(49.0 + metres * metre), radians(8.4), 0.0};
}

// A road to the north through 49 N 8.4 E with a junction every 500 m, from 10 km south to 20 km
// north.
std::filesystem::path country(const std::filesystem::path& folder) {
  const auto osm = folder / "country.osm";
  {
    std::ofstream out(osm);
    out << "<osm version=\"0.6\">";
    constexpr int first = -20, last = 40;
    for (int i = first; i <= last; ++i)
      for (const int side : {0, 1})
        out << "<node id=\"" << 1000 + 2 * i + side << "\" lat=\"" << 49.0 + 500.0 * i * metre
            << "\" lon=\"" << 8.4 + 0.002 * side << "\"/>";
    const auto way = [&](int id, int from, int to) {
      out << "<way id=\"" << id << "\"><nd ref=\"" << from << "\"/><nd ref=\"" << to
          << "\"/><tag k=\"highway\" v=\"residential\"/></way>";
    };
    for (int i = first; i <= last; ++i) {
      way(5000 + i, 1000 + 2 * i, 1001 + 2 * i);
      if (i < last) way(6000 + i, 1000 + 2 * i, 1002 + 2 * i);
    }
    out << "</osm>";
  }
  const auto tiles = folder / "country.tiles";
  mapmatch::build_tiled_map(osm, tiles);
  return tiles;
}

std::shared_ptr<const RoadMap> map_of(const std::filesystem::path& file) {
  MapParameters parameters;
  parameters.file = file.string();
  return load_road_map(parameters);
}

bool has_road(const MapWindow& window, const Geodetic& place) {
  return window.network()->size() > 0 &&
         mapmatch::covers(mapmatch::area_of(*window.network()), place, 0.0);
}

TEST(MapWindow, GoesWithTheVehicle) {
  TemporaryFolder folder;
  MapWindow window(map_of(country(folder.path())));
  EXPECT_TRUE(window.moves());
  EXPECT_EQ(window.network()->size(), 0u);
  EXPECT_FALSE(window.follow({std::nan(""), 0.0, 0.0}));
  int changes = 0;
  for (double driven = 0.0; driven < 15000.0; driven += 100.0) {
    changes += window.follow(north_of_start(driven)) ? 1 : 0;
    for (const double around : {-1400.0, 1400.0})
      EXPECT_TRUE(has_road(window, north_of_start(driven + around))) << driven;
  }
  EXPECT_EQ(changes, 8) << "once for the start, and each 2.1 km";
  EXPECT_FALSE(has_road(window, north_of_start(0.0))) << "the roads behind are left";
  EXPECT_TRUE(window.follow(north_of_start(0.0))) << "a leap needs other roads at once";
  EXPECT_TRUE(has_road(window, north_of_start(0.0)));
  EXPECT_TRUE(window.follow(north_of_start(1e6)));
  EXPECT_EQ(window.network()->size(), 0u) << "there is no map";
  EXPECT_EQ(window.failures().count, 0u);
}

TEST(MapWindow, OfAMapWithoutTilesNeverChanges) {
  TemporaryFolder folder;
  country(folder.path());
  MapWindow window(map_of(folder.path() / "country.osm"));
  EXPECT_FALSE(window.moves());
  EXPECT_EQ(window.network()->size(), 119u);
  EXPECT_FALSE(window.follow(north_of_start(9e5)));
}

TEST(MapWindow, IsArchivedWithWhatItReads) {
  TemporaryFolder folder;
  const auto map = map_of(country(folder.path()));
  MapWindow window(map), loaded(map);
  window.follow(north_of_start(0.0));
  window.follow(north_of_start(2200.0));
  ArchiveWriter writer;
  writer(window);
  ArchiveReader reader(writer.content());
  reader(loaded);
  reader.finish();
  EXPECT_EQ(loaded.network()->size(), window.network()->size());
  for (MapWindow* w : {&window, &loaded}) {
    EXPECT_TRUE(w->follow(north_of_start(2600.0)));
    EXPECT_TRUE(has_road(*w, north_of_start(6100.0))) << "about 2200 m, where reading began";
  }
}

TEST(MapWindow, WithoutTheRoadsOfADamagedTileGoesOnAndCounts) {
  TemporaryFolder folder;
  const auto file = country(folder.path());
  {
    const mapmatch::TileEntry first = mapmatch::TiledMap(file).table().tiles.front();
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(static_cast<std::streamoff>(first.offset + first.size - 1));
    out.put('x');
  }
  MapWindow window(map_of(file));
  EXPECT_TRUE(window.follow(north_of_start(-9500.0)));
  EXPECT_EQ(window.network()->size(), 0u);
  EXPECT_EQ(window.failures().count, 1u);
  EXPECT_THAT(window.failures().last, ::testing::HasSubstr("the tile at"));
  EXPECT_FALSE(window.follow(north_of_start(-9300.0)));
  EXPECT_TRUE(window.follow(north_of_start(-8900.0))) << "it tries again";
  EXPECT_EQ(window.failures().count, 2u);
  EXPECT_TRUE(window.follow(north_of_start(5000.0)));
  EXPECT_TRUE(has_road(window, north_of_start(5000.0)));
  EXPECT_EQ(window.failures().count, 2u);
}

// The fake drive goes north from 49 N 8.4 E at 10 m/s for 90 m. The window changes at the first
// state and, since two changes are some seconds apart, once more on the way.
TEST(MapWindow, ADriveOverTilesMatchesAsOverTheWholeMapAndResumes) {
  TemporaryFolder folder;
  const auto tiles = [&] {
    RoadMap map = *map_of(country(folder.path()));
    map.window = {.reach = 100.0, .begins_at = 20.0, .goes_over_at = 30.0};
    return std::make_shared<const RoadMap>(std::move(map));
  }();
  const auto run = [](std::shared_ptr<const RoadMap> map, const Snapshot* from,
                      std::vector<Time> cuts) {
    Drive d{.sensors = fake_sensors(14.0), .map = std::move(map)};
    d.config.map.mode = MapMode::tight;
    d.from = from;
    d.cuts = std::move(cuts);
    return drive(std::move(d));
  };
  std::vector<Time> cuts;
  for (const int ms : {1000, 5000, 8200, 9000, 10000, 12000})
    cuts.push_back(drive_start + milliseconds(ms));
  const Driven whole = run(tiles, nullptr, cuts);
  const Driven plain = run(map_of(folder.path() / "country.osm"), nullptr, {});
  ASSERT_EQ(whole.matches.size(), plain.matches.size());
  std::size_t on_road = 0;
  for (std::size_t i = 0; i < whole.matches.size(); ++i) {
    EXPECT_EQ(whole.matches[i].way_id, plain.matches[i].way_id);
    EXPECT_NEAR(whole.matches[i].probability, plain.matches[i].probability, 0.05) << i;
    on_road += whole.matches[i].on_road ? 1 : 0;
  }
  EXPECT_GT(on_road, 120u);
  ASSERT_FALSE(whole.states.empty());
  EXPECT_NEAR((whole.states.back().position_enu - plain.states.back().position_enu).norm(), 0.0,
              0.05);
  testing::expect_resumes(whole, [&](const Snapshot* from) { return run(tiles, from, {}); });
}

TEST(MapWindow, TheSideOfTrafficIsThatOfTheWholeMap) {
  TemporaryFolder folder;
  const auto osm = folder.path() / "island.osm";
  {
    std::ofstream out(osm);
    out << "<osm version=\"0.6\">";
    const auto node = [&](int id, double east, double north) {
      out << "<node id=\"" << id << "\" lat=\"" << 49.0 + north * metre << "\" lon=\""
          << 8.4 + east * metre / 0.656 << "\"/>";
    };
    // Two carriageways 15 m apart; the one that leads to the north is in the west.
    for (const int end : {0, 1}) {
      node(1 + end, 0.0, 1000.0 * end);
      node(3 + end, 15.0, 1000.0 * end);
      node(5 + end, 0.0, 20'000.0 + 500.0 * end);
    }
    const auto way = [&](int id, int from, int to, const char* oneway) {
      out << "<way id=\"" << id << "\"><nd ref=\"" << from << "\"/><nd ref=\"" << to
          << "\"/><tag k=\"highway\" v=\"primary\"/><tag k=\"name\" v=\"Main Road\"/><tag k=\""
             "oneway\" v=\""
          << oneway << "\"/></way>";
    };
    way(10, 1, 2, "yes");
    way(11, 4, 3, "yes");
    way(12, 5, 6, "no");
    out << "</osm>";
  }
  mapmatch::build_tiled_map(osm, folder.path() / "island.tiles");
  MapWindow window(map_of(folder.path() / "island.tiles"));
  ASSERT_TRUE(window.follow(north_of_start(500.0)));
  EXPECT_EQ(window.network()->size(), 2u);
  EXPECT_TRUE(window.network()->left_hand_traffic());
  ASSERT_TRUE(window.follow(north_of_start(20'200.0)));
  EXPECT_EQ(window.network()->size(), 1u);
  EXPECT_TRUE(window.network()->left_hand_traffic()) << "the map shows it elsewhere";
}

}  // namespace
}  // namespace maploop::vehicle::map_window_test
