// Tests `maploop replay` as users run it: its files, its errors, and how it ends.
#include <csignal>
#include <utility>

#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

class ReplayOfDrive : public DriveTest {
 protected:
  // Replays the drive in lockstep, without LCM.
  static ProcessResult lockstep(Words options) {
    options.insert(options.begin(), {"replay", drive(), "--no-lcm", "--lockstep"});
    return run_maploop(options);
  }

  // Starts a paced replay, and returns it when it shows states.
  std::unique_ptr<Process> started(Words options) const {
    options.insert(options.begin(),
                   {maploop_command(), "replay", drive(), "--no-lcm", "--record", file("log")});
    std::filesystem::remove(file("log"));
    auto process = std::make_unique<Process>(options);
    EXPECT_TRUE(comes_to_contain(file("log"), "NAV_STATE")) << "it is on its way";
    return process;
  }
};

TEST_F(ReplayOfDrive, TheLastPassOfALoopIsLikeTheFirst) {
  const auto expected = hashes(replay(drive(), {"--lockstep", "--end", "2"}));
  EXPECT_EQ(hashes(replay(drive(), {"--lockstep", "--end", "2", "--loop", "3"})), expected);
  EXPECT_EQ(hashes(replay(drive(), {"--speed", "4", "--end", "2", "--loop", "2"})), expected);
}

TEST_F(ReplayOfDrive, ALogOfALogHasTheSameBytes) {
  replay(drive(), {"--lockstep", "--end", "3", "--record", file("a.lcmlog"), "--record-raw"});
  replay(file("a.lcmlog"), {"--lockstep", "--record", file("b.lcmlog"), "--record-raw"});
  const ProcessResult same = run_maploop({"log", "diff", file("a.lcmlog"), file("b.lcmlog")});
  EXPECT_EQ(same.status, 0) << same.out;
  for (const char* channel : {"CAMERA: same", "VELODYNE: same", "CALIBRATION: same"}) {
    EXPECT_THAT(same.out, HasSubstr(channel));
  }
}

TEST_F(ReplayOfDrive, InterruptEndsInOrderWithTheVerdictAndTheTables) {
  const auto process = started({"--verbose"});
  process->send_signal(SIGINT);
  const ProcessResult result = process->wait();
  EXPECT_EQ(result.status, 130);
  EXPECT_THAT(result.out, AllOf(StartsWith("Interrupted after "), HasSubstr("NAV_STATE")));
}

TEST_F(ReplayOfDrive, EverySignalThatEndsARunEndsItInOrderAlsoWhenItComesTwice) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto process =
        started({"--start", "4", "--tum", file("states.tum"), "--json", file("table.json")});
    // The first states are of no image.
    EXPECT_TRUE(comes_to_contain(file("log"), "ODOMETRY", 20));
    process->send_signal(signal);
    process->send_signal(signal);  // as sent by a program that signals its whole group
    const ProcessResult result = process->wait();
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_THAT(result.out, StartsWith("Interrupted after "));
    EXPECT_TRUE(read_json(file("table.json"))["interrupted"]);
    EXPECT_GT(std::filesystem::file_size(file("states.tum")), 0u);
    std::filesystem::remove(file("table.json"));
    std::filesystem::remove(file("states.tum"));
  }
}

TEST_F(ReplayOfDrive, ATableThatNobodyTakesIsAnErrorAndTheFilesAreThere) {
  const std::string table = file("table.json");
  std::string replay_to;
  for (const std::string& word : Words{maploop_command(), "replay", drive(), "--no-lcm",
                                       "--lockstep", "--end", "2", "--json", table}) {
    replay_to += "'" + word + "' ";
  }
  for (const char* output : {"> /dev/full", ">&-"}) {
    std::filesystem::remove(table);
    const ProcessResult result = run({"/bin/sh", "-c", replay_to + output});
    EXPECT_EQ(result.status, 1) << output;
    EXPECT_THAT(result.error, HasSubstr("standard output was not taken"));
    EXPECT_TRUE(read_json(table).contains("degraded")) << output;
  }
}

TEST_F(ReplayOfDrive, AFileThatTheDiskRefusesIsSaidAndTheOthersAreThere) {
  const ProcessResult result =
      lockstep({"--end", "2", "--json", "/dev/full", "--tum", file("states.tum")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("cannot write '/dev/full': No space left on device"));
  EXPECT_GT(std::filesystem::file_size(file("states.tum")), 0u);
}

TEST_F(ReplayOfDrive, EndsWithAVerdictOfThreeLines) {
  const ProcessResult result =
      lockstep({"--end", "4", "--configuration", "VO-L-RI", "--json", file("result.json")});
  EXPECT_EQ(result.status, 0) << result.error;
  std::istringstream lines(result.out);
  Words said;
  for (std::string line; std::getline(lines, line);) said.push_back(line);
  ASSERT_EQ(said.size(), 3u) << result.out;
  EXPECT_THAT(said[0], StartsWith("After 4."));
  EXPECT_THAT(said[1], StartsWith("Horizontal error "));
  EXPECT_THAT(said[2], AllOf(StartsWith("VO-L-RI did not use GNSS after the start ("),
                             HasSubstr("GNSS+VO-L-RI uses it")));
  EXPECT_EQ(read_json(file("result.json"))["verdict"], json(said));
}

// Makes links to the recorded drive, without one of its folders.
std::filesystem::path drive_without(const char* part, const std::filesystem::path& folder) {
  auto drive = folder / "2011_09_26/drive";
  std::filesystem::create_directories(drive);
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::drive_0013().parent_path())) {
    if (entry.is_regular_file()) {
      std::filesystem::create_symlink(entry.path(), drive.parent_path() / entry.path().filename());
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(testing::drive_0013())) {
    if (entry.path().filename() != part) {
      std::filesystem::create_directory_symlink(entry.path(), drive / entry.path().filename());
    }
  }
  return drive;
}

TEST_F(ReplayOfDrive, WithoutAPositionFailsAndSaysWhy) {
  const std::string no_oxts = drive_without("oxts", folder_.path()).string();
  EXPECT_THAT(refusal(no_oxts, {"--lockstep", "--end", "1", "--tum", file("out.tum")}),
              HasSubstr("there is no position: the recording has no GNSS"));
  const ProcessResult no_fix =
      lockstep({"--end", "1", "--fault", "lost@gnss:0:end", "--tum", file("out.tum")});
  EXPECT_EQ(no_fix.status, 1);
  EXPECT_THAT(no_fix.error, HasSubstr("no GNSS came to start from"));
  EXPECT_THAT(no_fix.out, HasSubstr("no position."));
}

TEST_F(ReplayOfDrive, ASnapshotThatIsNotTakenIsAnError) {
  EXPECT_THAT(lockstep({"--end", "1", "--snapshot", "60:" + file("a.snapshot")}).error,
              HasSubstr("--snapshot 60 s lies outside of what is played, 0 s to 1 s"));
  EXPECT_FALSE(std::filesystem::exists(file("a.snapshot")));
  for (const char* request : {"soon:a", "-1:a", "5"}) {
    EXPECT_THAT(lockstep({"--snapshot", request}).error, HasSubstr("SECONDS:FILE"));
  }
}

TEST_F(ReplayOfDrive, WhatCannotWorkIsRefused) {
  EXPECT_THAT(refusal(drive(), {"--map-mode", "loose"}), HasSubstr("needs a map: --map FILE"));
  EXPECT_THAT(refusal(drive(), {"--start", "100"}),
              HasSubstr("--start 100 lies after the end, at 14.8"));
}

TEST_F(ReplayOfDrive, SurvivesADriveWithAHole) {
  const auto date = folder_.path() / "2011_09_26";
  const auto copy = date / "2011_09_26_drive_0013_sync";
  std::filesystem::create_directories(date);
  for (const auto& entry : std::filesystem::directory_iterator(drive_0013().parent_path())) {
    if (entry.is_regular_file()) std::filesystem::copy(entry, date);
  }
  std::filesystem::copy(drive_0013(), copy, std::filesystem::copy_options::recursive);
  std::filesystem::remove(copy / "image_00/data/0000000050.png");
  std::filesystem::resize_file(copy / "image_01/data/0000000060.png", 1000);
  std::filesystem::resize_file(copy / "velodyne_points/data/0000000070.bin", 1001);

  const ProcessResult result = run_maploop({"replay", copy.string(), "--no-lcm", "--lockstep",
                                            "--verbose", "--json", file("result.json")});
  EXPECT_EQ(result.status, 0) << result.error;
  for (const char* name : {"0000000050.png", "0000000060.png", "0000000070.bin"}) {
    EXPECT_THAT(result.out, HasSubstr(name));
  }
  const json r = read_json(file("result.json"));
  EXPECT_EQ(r["sensors"]["camera"]["delivered"], 142);
  EXPECT_EQ(r["sensors"]["camera"]["left_out"], 2);
  EXPECT_EQ(r["sensors"]["velodyne"]["left_out"], 1);
  EXPECT_LT(r["fused"]["end_point_m"], 10.0) << "two lost images are bridged";
}

TEST_F(ReplayOfDrive, TheReportHoldsAllOfIt) {
  const ProcessResult result = lockstep({"--end", "2", "--configuration", "VO-L-RI", "--fault",
                                         "lost@imu:1:0.1", "--report", file("report.html")});
  ASSERT_EQ(result.status, 0) << result.error;
  const std::string page = read_file(file("report.html"));
  EXPECT_LT(page.find("VO-L-RI did not use GNSS after the start"), page.find("Way of the vehicle"))
      << "the verdict opens the page";
  for (const char* part : {"2011_09_26_drive_0013_sync", "Way of the vehicle", "stereo odometry",
                           "Error azimuth", "lost@imu:1:0.1", "camera -&gt; stereo", "NAV_STATE",
                           "Processor time", "[fusion]", "\"fused\""}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_THAT(refusal(drive(), {"--lockstep", "--end", "1", "--report", "/dev/null/r.html"}),
              HasSubstr("/dev/null/r.html"));
}

// On a table of OXTS rows, which takes a fraction of a second.
class ReplayOfTable : public CommandTest {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }

  static std::string table() { return (real_data() / "kitti_odometry/oxts/04.csv.gz").string(); }
  static std::string map(const char* name) { return (real_data() / "maps" / name).string(); }
};

TEST_F(ReplayOfTable, MatchesToAMapAndScoresTheLinks) {
  const auto run = [this](Words how) {
    how.insert(how.begin(), {"--lockstep", "--configuration", "GNSS+RISS", "--map",
                             map("karlsruhe_2012-04.osm.pbf")});
    return replay(table(), how);
  };
  const json loose = run({});
  EXPECT_EQ(loose["channels"]["MAP_MATCH"]["count"], 282);
  EXPECT_GE(loose["links"]["all"]["fixes"], 270);
  EXPECT_EQ(loose["links"]["all"]["right"], 1.0);
  EXPECT_EQ(loose["links"]["certain"]["coverage"], 1.0);
  EXPECT_EQ(hashes(loose), hashes(run({})));
  const json unmatched = run({"--map-mode", "none"});
  EXPECT_TRUE(unmatched["links"].is_null());
  EXPECT_FALSE(unmatched["channels"].contains("MAP_MATCH"));
  EXPECT_EQ(hashes(unmatched)["NAV_STATE"], hashes(loose)["NAV_STATE"]);
}

TEST_F(ReplayOfTable, AMapOfAnotherPlaceFails) {
  EXPECT_THAT(refusal(table(), {"--lockstep", "--configuration", "GNSS+RISS", "--map",
                                map("liechtenstein_2015-07.osm.pbf")}),
              AllOf(HasSubstr("far outside of the map, which covers 47."),
                    HasSubstr("no position was on a road of the map")));
}

TEST_F(ReplayOfTable, MayHaveAnyNameInAnyFolder) {
  std::filesystem::copy(table(), file("to work.csv.gz"));
  const ProcessResult result = run_maploop(
      {"replay", file("to work.csv.gz"), "--no-lcm", "--lockstep", "--configuration", "GNSS+RISS"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("Horizontal error "));
}

TEST_F(ReplayOfTable, PosesOfACameraThatIsNotThereAreRefusedBeforeTheDrive) {
  const auto car = real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz";
  const ProcessResult result =
      run_maploop({"replay", car.string(), "--no-lcm", "--lockstep", "--tum", file("out.tum")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("would be empty: the recording has no images"));
  EXPECT_EQ(result.out, "");
}

using ReplayCommand = CommandTest;

TEST_F(ReplayCommand, NamesAFolderThatIsNoDrive) {
  const std::string folder = folder_.path().string();
  EXPECT_THAT(refusal(folder, {}), HasSubstr(folder));
}

TEST_F(ReplayCommand, SaysWhatWasPerhapsMeant) {
  const auto misused = [](const Words& words) {
    const ProcessResult result = run_maploop(words);
    EXPECT_EQ(result.status, 2);
    return result.error;
  };
  EXPECT_THAT(misused({"reply"}), HasSubstr("did you mean 'replay'"));
  EXPECT_THAT(misused({"replay", "x", "--lockstp"}), HasSubstr("did you mean '--lockstep'"));
  EXPECT_THAT(misused({"map"}), HasSubstr("Usage: maploop map"));
}

TEST_F(ReplayCommand, SaysWhatIsWrongWithItsArguments) {
  for (const Words& wrong : {Words{},
                             {"x", "--speed", "0"},
                             {"x", "--speed", "2", "--lockstep"},
                             {"x", "--nonsense"},
                             {"x", "--config", "/nonexistent.toml"}}) {
    Words words{"replay"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    EXPECT_NE(run_maploop(words).status, 0);
  }
  EXPECT_THAT(refusal("x", {"--config", "/nonexistent.toml"}), HasSubstr("/nonexistent.toml"));
  EXPECT_EQ(run_maploop({"replay", "--help"}).status, 0);
}

TEST_F(ReplayCommand, NamesTheUnknownKeyOfAConfiguration) {
  const std::string config = write("bad.toml", "[fusion]\ngyro_nois = 1e-4\n");
  EXPECT_THAT(refusal("x", {"--config", config}),
              AllOf(HasSubstr("bad.toml:2"), HasSubstr("gyro_nois"), HasSubstr("gyro_noise")))
      << "says the nearest known key";
}

}  // namespace
}  // namespace maploop
