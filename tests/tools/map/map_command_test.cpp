// Tests `maploop map` and what uses its maps, as a user runs them.
#include "tests/support/command_test.h"

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
    EXPECT_THAT(refused.error, HasSubstr("would replace the map"));
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

}  // namespace
}  // namespace maploop::map_command_test
