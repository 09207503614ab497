#include "runtime/vehicle/stages/map_window.h"

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
  EXPECT_EQ(window.failures(), 0u);
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
    const mapmatch::TileEntry first = mapmatch::TiledMap(file).tiles().front();
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(static_cast<std::streamoff>(first.offset + first.size - 1));
    out.put('x');
  }
  MapWindow window(map_of(file));
  EXPECT_TRUE(window.follow(north_of_start(-9500.0)));
  EXPECT_EQ(window.network()->size(), 0u);
  EXPECT_EQ(window.failures(), 1u);
  EXPECT_TRUE(window.follow(north_of_start(5000.0)));
  EXPECT_TRUE(has_road(window, north_of_start(5000.0)));
}

// The fake drive goes north from 49 N 8.4 E at 10 m/s.
TEST(MapWindow, ADriveOverTilesMatchesAsOverTheWholeMapAndResumes) {
  TemporaryFolder folder;
  const auto tiles = map_of(country(folder.path()));
  const auto run = [](std::shared_ptr<const RoadMap> map, const Snapshot* from,
                      std::vector<Time> cuts) {
    Drive d{.sensors = fake_sensors(9.0), .map = std::move(map)};
    d.config.map.mode = MapMode::tight;
    d.from = from;
    d.cuts = std::move(cuts);
    return drive(std::move(d));
  };
  const Driven whole =
      run(tiles, nullptr, {drive_start + milliseconds(1000), drive_start + milliseconds(5000)});
  const Driven plain = run(map_of(folder.path() / "country.osm"), nullptr, {});
  ASSERT_EQ(whole.matches.size(), plain.matches.size());
  std::size_t on_road = 0;
  for (std::size_t i = 0; i < whole.matches.size(); ++i) {
    EXPECT_EQ(whole.matches[i].way_id, plain.matches[i].way_id);
    on_road += whole.matches[i].on_road ? 1 : 0;
  }
  EXPECT_GT(on_road, 80u);
  testing::expect_resumes(whole, [&](const Snapshot* from) { return run(tiles, from, {}); });
}

}  // namespace
}  // namespace maploop::vehicle::map_window_test
