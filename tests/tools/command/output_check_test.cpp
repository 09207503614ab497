// Commands run as a user would, whose outputs would destroy what they read, or each other.
#include "tests/mapmatch/osm_file.h"
#include "tests/support/command_test.h"

namespace maploop::output_check_test {
namespace {

using namespace maploop::testing;

constexpr const char* track = R"(<gpx><trk><trkseg>
<trkpt lat="49.012" lon="8.41"><time>2020-01-01T02:00:00+02:00</time></trkpt>
<trkpt lat="49.013" lon="8.41"><time>2020-01-01T00:00:10Z</time></trkpt>
</trkseg></trk></gpx>)";

class OutputCheck : public CommandTest {
 protected:
  void refused(const Words& words, const char* why) {
    const ProcessResult result = run_maploop(words);
    EXPECT_EQ(result.status, 1) << result.out;
    EXPECT_THAT(result.error, HasSubstr(why));
    EXPECT_EQ(read_file(map_), street_);
    EXPECT_EQ(read_file(track_), track);
  }

  const std::string map_ =
      OsmFile(file(".")).node(1, 49.01, 8.41).node(2, 49.02, 8.41).road(10, {1, 2}).write();
  const std::string street_ = read_file(map_), track_ = write("track.gpx", track);
};

TEST_F(OutputCheck, NoOutputReplacesAnInput) {
  refused({"match", map_, track_, "--gpx", track_}, "it is read (TRACK)");
  refused({"match", map_, track_, "--csv", file("./small.osm")}, "it is read (MAP)");
  refused({"map", "info", map_, "--json", map_}, "it is read (MAP)");
  refused({"map", "doubts", map_, track_, "-o", track_}, "it is read (TRACK)");
}

TEST_F(OutputCheck, NoOutputReplacesAFileOfAFolderThatIsRead) {
  std::filesystem::create_directory(file("drive"));
  const std::string fixes = write("drive/gnss.csv", "t,lat,lon\n1,49,8\n");
  refused({"replay", file("drive"), "--lockstep", "--no-lcm", "--csv", fixes},
          "it is there in the folder");
  refused({"doctor", file("drive"), "--json", file("drive/../drive/gnss.csv")},
          "it is there in the folder");
  EXPECT_EQ(read_file(fixes), "t,lat,lon\n1,49,8\n");
}

TEST_F(OutputCheck, ResultsOfSeveralTracksDoNotReplaceThem) {
  const std::string other = write("other.gpx", track), folder = file(".");
  refused({"match", map_, track_, other, "--gpx", folder}, "would replace the track");
  EXPECT_EQ(run_maploop({"match", map_, track_, other, "--csv", folder}).status, 0);
}

TEST_F(OutputCheck, NoTwoOutputsAreOneFile) {
  refused({"match", map_, track_, "--csv", file("new"), "--gpx", file("./new")},
          "--csv is written there");
  const Words nowhere{"match", map_, track_, "--csv", "/dev/null", "--gpx", "/dev/null"};
  EXPECT_EQ(run_maploop(nowhere).status, 0);
}

TEST_F(OutputCheck, FilesBesideTheOneThatIsNamedCount) {
  const auto replay = [&](const Words& options) {
    Words words{"replay", track_, "--no-lcm", "--lockstep"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  };
  refused(replay({"--snapshot", "3:" + track_}), "it is read (DRIVE)");
  refused(replay({"--snapshot", "3:" + file("new"), "--csv", file("new")}), "is written there");
  refused(replay({"--state", file("car"), "--csv", file("car.ppp")}), "is written there");
  std::filesystem::create_directory(file("empty"));
  write("extrinsics.toml", "");
  refused({"calibrate", "extrinsics", file("empty"), "--config", file("extrinsics.toml"), "--toml",
           file("extrinsics.toml")},
          "it is read (--config)");
}

TEST_F(OutputCheck, AMapThatIsANetworkAlreadyIsNamed) {
  const std::string network = file("street.net"), doubts = file("doubts.geojson");
  ASSERT_EQ(run_maploop({"map", "build", map_, network}).status, 0);
  ASSERT_EQ(run_maploop({"map", "doubts", map_, track_, "-o", doubts}).status, 0);
  refused({"map", "build", network, file("other.net"), "--doubts", doubts},
          "give the map that it was made from");
}

TEST_F(OutputCheck, ATrackThatCannotBeUsedDoesNotStopTheOthers) {
  const std::string cut = write("cut.gpx", std::string(track).substr(0, 100));
  const std::string doubts = file("doubts.geojson");
  const ProcessResult result = run_maploop({"map", "doubts", map_, cut, track_, "-o", doubts});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("2 fixes of 1 tracks"));
  EXPECT_THAT(result.error, AllOf(HasSubstr("cut.gpx:"), HasSubstr("was it cut"),
                                  HasSubstr("1 of 2 tracks could not be used")));
  EXPECT_TRUE(std::filesystem::exists(doubts));
}

TEST_F(OutputCheck, ABoxOfANetworkFileIsRefused) {
  const std::string network = file("street.net");
  ASSERT_EQ(run_maploop({"map", "build", map_, network}).status, 0);
  refused({"map", "info", network, "--box", "8,49,9,50"}, "a network file is read whole");
}

TEST_F(OutputCheck, TimesOfATrackMayHaveAnOffset) {
  const std::string csv = file("matched.csv");
  ASSERT_EQ(run_maploop({"match", map_, track_, "--csv", csv}).status, 0);
  EXPECT_THAT(read_file(csv), HasSubstr("\n1577836800.000000,49.012")) << "and not two hours later";
}

}  // namespace
}  // namespace maploop::output_check_test
