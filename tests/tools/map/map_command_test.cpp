// Tests `maploop map` and what uses its maps, as a user runs them.
#include "tests/support/command_test.h"
#include "tests/support/real_data.h"

namespace maploop::map_command_test {
namespace {

using namespace maploop::testing;

constexpr const char* street = R"(<osm version="0.6">
<node id="1" lat="49.01" lon="8.41"/><node id="2" lat="49.02" lon="8.41"/>
<way id="10"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way></osm>)";

class MapCommand : public CommandTest {};

TEST_F(MapCommand, DoesNotReplaceTheMapByItsResult) {
  const std::string map = write("street.osm", street);
  for (const Words& form : {Words{}, Words{"--tiles"}}) {
    Words words{"map", "build", map, map};
    words.insert(words.end(), form.begin(), form.end());
    const ProcessResult refused = run_maploop(words);
    EXPECT_EQ(refused.status, 1) << refused.out;
    EXPECT_THAT(refused.error, HasSubstr("it is read (MAP)"));
    EXPECT_EQ(read_file(map), street);
  }
}

TEST_F(MapCommand, ATrackFarFromATiledMapIsToldWhereTheMapIs) {
  const std::string tiles = file("street.tiles");
  ASSERT_EQ(run_maploop({"map", "build", write("street.osm", street), tiles, "--tiles"}).status, 0);
  const std::string track =
      write("track.gpx",
            R"(<gpx><trk><trkseg><trkpt lat="50.01" lon="8.41"><time>2020-01-01T00:00:00Z</time>)"
            R"(</trkpt></trkseg></trk></gpx>)");
  const ProcessResult refused = run_maploop({"match", tiles, track, "--csv", file("m.csv")});
  EXPECT_EQ(refused.status, 1) << refused.out;
  EXPECT_THAT(refused.error, HasSubstr("the map covers 49."));
  EXPECT_THAT(refused.error, HasSubstr("no track is near"));
}

// A real drive through a map from which a street was taken.
TEST_F(MapCommand, DoubtsCorrectANetworkAndATiledMapAlike) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string map = (real_data() / "maps/karlsruhe_00_road_missing.osm.pbf").string();
  const std::string track = (real_data() / "kitti_odometry/oxts/00.csv.gz").string();
  const std::string doubts = file("doubts.geojson");
  ASSERT_EQ(run_maploop({"map", "doubts", map, track, "-o", doubts}).status, 0);
  for (const Words& form : {Words{}, Words{"--tiles"}}) {
    for (const Words& correction : {Words{}, Words{"--doubts", doubts}}) {
      const std::string built = file("built" + std::to_string(form.size() + correction.size()));
      Words words{"map", "build", map, built};
      words.insert(words.end(), form.begin(), form.end());
      words.insert(words.end(), correction.begin(), correction.end());
      const ProcessResult building = run_maploop(words);
      ASSERT_EQ(building.status, 0) << building.error;
      const ProcessResult matched = run_maploop({"match", built, track});
      if (correction.empty()) {
        EXPECT_THAT(matched.out, HasSubstr("4541 fixes, 4398 on a road"));
      } else {
        EXPECT_THAT(building.out, HasSubstr("corrected: 1 missing roads"));
        EXPECT_THAT(matched.out, HasSubstr("4541 fixes, 4541 on a road"));
      }
    }
  }
}

}  // namespace
}  // namespace maploop::map_command_test
