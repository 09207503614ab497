// Tests `maploop replay` as users run it, on the recorded drive.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tests/tools/replay/channel_hashes.h"
#include "tools/evaluate/kitti_poses.h"

namespace maploop {
namespace {

using nlohmann::json;
using testing::hashes;
using testing::ProcessResult;
using testing::TemporaryFolder;

std::vector<std::string> command(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {testing::maploop_command(), "replay"});
  return arguments;
}

ProcessResult replay(const std::vector<std::string>& arguments) {
  return testing::run(command(arguments));
}

json replay_json(std::vector<std::string> options) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  options.insert(options.end(), {testing::drive_0013().string(), "--no-lcm", "--json", file});
  const ProcessResult result = replay(options);
  EXPECT_EQ(result.status, 0) << result.error;
  return json::parse(std::ifstream(file));
}

TEST(ReplayCommand, RealTimeHasTheBitsOfLockstepAndLosesNothing) {
  MAPLOOP_REQUIRE_DRIVE();
  const json lockstep = replay_json({"--lockstep"});
  const json real_time = replay_json({"--speed", "1"});
  EXPECT_EQ(hashes(lockstep), hashes(real_time));
  EXPECT_EQ(hashes(lockstep).size(), 7u);
  for (const json& result : {lockstep, real_time}) EXPECT_EQ(result["replay"]["lost"], 0);
  EXPECT_EQ(real_time["channels"]["VO"]["count"], 144);
  EXPECT_EQ(real_time["channels"]["IMU"]["count"], 144);
  EXPECT_EQ(real_time["channels"]["TRUTH"]["count"], 144);
  EXPECT_GT(real_time["channels"]["HEALTH"]["count"], 10);
}

TEST(ReplayCommand, StaysAsAccurateAsItWas) {
  MAPLOOP_REQUIRE_DRIVE();
  const json r = replay_json({"--lockstep"});
  EXPECT_EQ(r["vo"]["frames"], 144);
  EXPECT_EQ(r["fused"]["frames"], 144);
  EXPECT_NEAR(r["vo"]["distance_m"], 172.9, 0.5);
  // The results are 0.916, 0.493, 0.00170, 2.06 m.
  EXPECT_LT(r["vo"]["segment_100m_percent"], 1.0);
  EXPECT_LT(r["vo"]["common_rotation_removed"]["segment_100m_percent"], 0.55);
  EXPECT_LT(r["vo"]["segment_100m_deg_per_m"], 0.0021);
  EXPECT_LT(r["vo"]["end_point_m"], 2.3);
  // The results are 0.653, 0.505, 0.00249, 1.50 m.
  EXPECT_LT(r["lidar"]["segment_100m_percent"], 0.72);
  EXPECT_LT(r["lidar"]["common_rotation_removed"]["segment_100m_percent"], 0.55);
  EXPECT_LT(r["lidar"]["segment_100m_deg_per_m"], 0.003);
  EXPECT_LT(r["lidar"]["end_point_m"], 1.7);
  // The results are 0.640, 0.515, 0.00151, 1.68 m.
  EXPECT_LT(r["fused"]["segment_100m_percent"], 0.7);
  EXPECT_LT(r["fused"]["common_rotation_removed"]["segment_100m_percent"], 0.55);
  EXPECT_LT(r["fused"]["segment_100m_deg_per_m"], 0.002);
  EXPECT_LT(r["fused"]["end_point_m"], 1.8);
  // One trigger exposes both images, so that no odometry speed contradicts the filter.
  EXPECT_FALSE(r["refusals"]["fusion"].contains("speed contradicts the prediction"));
}

TEST(ReplayCommand, StartAndEndChangeNoBitOfWhatLiesBetween) {
  MAPLOOP_REQUIRE_DRIVE();
  const json lockstep = replay_json({"--lockstep", "--end", "6"});
  EXPECT_EQ(hashes(lockstep), hashes(replay_json({"--start", "4", "--end", "6"})));
  EXPECT_LT(lockstep["channels"]["VO"]["count"], 62);
}

TEST(ReplayCommand, MatchesToAMapAndScoresTheLinks) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  const auto data = testing::real_data();
  const auto run = [&](const std::vector<std::string>& how) {
    std::vector<std::string> arguments{(data / "kitti_odometry/oxts/04.csv.gz").string(),
                                       "--no-lcm",
                                       "--configuration",
                                       "GNSS+RISS",
                                       "--map",
                                       (data / "maps/karlsruhe_2012-04.osm.pbf").string(),
                                       "--json",
                                       file};
    arguments.insert(arguments.end(), how.begin(), how.end());
    const ProcessResult result = replay(arguments);
    EXPECT_EQ(result.status, 0) << result.error;
    return json::parse(std::ifstream(file));
  };
  const json lockstep = run({"--lockstep"});
  EXPECT_EQ(lockstep["channels"]["MAP_MATCH"]["count"], 282);
  EXPECT_GE(lockstep["links"]["all"]["fixes"], 270);
  EXPECT_EQ(lockstep["links"]["all"]["right"], 1.0);
  EXPECT_EQ(lockstep["links"]["certain"]["coverage"], 1.0);
  EXPECT_EQ(hashes(lockstep), hashes(run({"--lockstep"})));
  const json unmatched = run({"--lockstep", "--map-mode", "none"});
  EXPECT_TRUE(unmatched["links"].is_null());
  EXPECT_FALSE(unmatched["channels"].contains("MAP_MATCH"));
  EXPECT_EQ(hashes(unmatched)["NAV_STATE"], hashes(lockstep)["NAV_STATE"]);
}

TEST(ReplayCommand, AMapModeWithoutAMapIsAnError) {
  MAPLOOP_REQUIRE_DRIVE();
  const ProcessResult result =
      replay({testing::drive_0013().string(), "--no-lcm", "--map-mode", "loose"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("needs a map: --map FILE"), std::string::npos) << result.error;
}

TEST(ReplayCommand, AStartAfterTheEndIsAnError) {
  MAPLOOP_REQUIRE_DRIVE();
  const ProcessResult result =
      replay({testing::drive_0013().string(), "--no-lcm", "--start", "100"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("--start 100 lies after the end, at 14.8"), std::string::npos)
      << result.error;
}

TEST(ReplayCommand, TooFastASpeedStallsTheClockNotTheResult) {
  MAPLOOP_REQUIRE_DRIVE();
  const json too_fast = replay_json({"--speed", "1000", "--end", "6"});
  EXPECT_GT(too_fast["replay"]["stalls"], 0);
  EXPECT_EQ(too_fast["replay"]["lost"], 0);
  EXPECT_EQ(hashes(too_fast), hashes(replay_json({"--lockstep", "--end", "6"})));
}

TEST(ReplayCommand, AnotherSeedIsAnotherDraw) {
  MAPLOOP_REQUIRE_DRIVE();
  const json one = replay_json({"--lockstep", "--end", "5", "--seed", "1"});
  const json two = replay_json({"--lockstep", "--end", "5", "--seed", "2"});
  EXPECT_NE(hashes(one)["GNSS_FIX"], hashes(two)["GNSS_FIX"]);
  EXPECT_EQ(hashes(one)["VO"], hashes(two)["VO"]);
}

TEST(ReplayCommand, WritesOnePoseAnImage) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "poses.txt").string();
  const ProcessResult result =
      replay({testing::drive_0013().string(), "--no-lcm", "--lockstep", "--poses", file});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(evaluation::read_kitti_poses(file).size(), 144u);
}

TEST(ReplayCommand, InterruptEndsInOrderWithTheVerdictAndTheTables) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const auto log = folder.path() / "log";
  testing::Process process(
      command({testing::drive_0013().string(), "--no-lcm", "--verbose", "--record", log.string()}));
  EXPECT_TRUE(testing::comes_to_contain(log, "NAV_STATE")) << "it is on its way";
  process.send_signal(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.out.find("Interrupted after "), 0u) << result.out;
  EXPECT_NE(result.out.find("NAV_STATE"), std::string::npos);
}

TEST(ReplayCommand, EverySignalThatEndsARunEndsItInOrderAlsoWhenItComesTwice) {
  MAPLOOP_REQUIRE_DRIVE();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    const auto log = folder.path() / "log", states = folder.path() / "states.tum",
               table = folder.path() / "table.json";
    testing::Process process(
        command({testing::drive_0013().string(), "--no-lcm", "--start", "4", "--record",
                 log.string(), "--tum", states.string(), "--json", table.string()}));
    EXPECT_TRUE(testing::comes_to_contain(log, "NAV_STATE")) << "it is where it is shown";
    process.send_signal(signal);
    process.send_signal(signal);  // as sent by a program that signals its whole group
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_EQ(result.out.find("Interrupted after "), 0u) << result.out;
    EXPECT_TRUE(json::parse(std::ifstream(table))["interrupted"]);
    EXPECT_GT(std::filesystem::file_size(states), 0u);
  }
}

TEST(ReplayCommand, ATableThatNobodyTakesIsAnErrorAndTheFilesAreThere) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "table.json").string();
  std::string replay_to;
  for (const std::string& word : command({testing::drive_0013().string(), "--no-lcm", "--lockstep",
                                          "--end", "2", "--json", file})) {
    replay_to += "'" + word + "' ";
  }
  for (const auto& [output, status] : {std::pair{"> /dev/full", 1}, std::pair{">&-", 1}}) {
    std::filesystem::remove(file);
    const ProcessResult result = testing::run({"/bin/sh", "-c", replay_to + output});
    EXPECT_EQ(result.status, status) << output;
    EXPECT_NE(result.error.find("standard output was not taken"), std::string::npos);
    EXPECT_TRUE(json::parse(std::ifstream(file)).contains("degraded")) << output;
  }
}

TEST(ReplayCommand, AFileThatTheDiskRefusesIsSaidAndTheOthersAreThere) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "states.tum").string();
  const ProcessResult result = replay({testing::drive_0013().string(), "--no-lcm", "--lockstep",
                                       "--end", "2", "--json", "/dev/full", "--tum", file});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("cannot write '/dev/full': No space left on device"),
            std::string::npos)
      << result.error;
  EXPECT_GT(std::filesystem::file_size(file), 0u);
}

TEST(ReplayCommand, EndsWithAVerdictOfThreeLines) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  const ProcessResult result = replay(
      {testing::drive_0013().string(), "--no-lcm", "--lockstep", "--end", "4", "--json", file});
  EXPECT_EQ(result.status, 0) << result.error;
  std::istringstream lines(result.out);
  std::vector<std::string> said;
  for (std::string line; std::getline(lines, line);) said.push_back(line);
  ASSERT_EQ(said.size(), 3u) << result.out;
  EXPECT_EQ(said[0].find("After 4."), 0u) << said[0];
  EXPECT_EQ(said[1].find("Horizontal error "), 0u) << said[1];
  EXPECT_EQ(said[2].find("VO-L-RI did not use GNSS after the start ("), 0u) << said[2];
  EXPECT_NE(said[2].find("GNSS+VO-L-RI uses it"), std::string::npos) << said[2];
  EXPECT_EQ(json::parse(std::ifstream(file))["verdict"], json(said));
}

// Makes links to the recorded drive, without one of its folders.
std::filesystem::path drive_without(const char* part, const std::filesystem::path& folder) {
  const auto drive = folder / "2011_09_26/drive";
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

TEST(ReplayCommand, WithoutAPositionFailsAndSaysWhy) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const auto tum = folder.path() / "out.tum";
  const ProcessResult no_oxts = replay({drive_without("oxts", folder.path()).string(), "--no-lcm",
                                        "--lockstep", "--end", "1", "--tum", tum.string()});
  EXPECT_EQ(no_oxts.status, 1);
  EXPECT_NE(no_oxts.error.find("there is no position: the recording has no GNSS"),
            std::string::npos)
      << no_oxts.error;
  const ProcessResult no_fix =
      replay({testing::drive_0013().string(), "--no-lcm", "--lockstep", "--end", "1", "--fault",
              "lost@gnss:0:end", "--tum", tum.string()});
  EXPECT_EQ(no_fix.status, 1);
  EXPECT_NE(no_fix.error.find("no GNSS came to start from"), std::string::npos) << no_fix.error;
  EXPECT_NE(no_fix.out.find("no position."), std::string::npos) << no_fix.out;
}

TEST(ReplayCommand, PosesOfACameraThatIsNotThereAreRefusedBeforeTheDrive) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const auto car = testing::real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz";
  const ProcessResult result = replay(
      {car.string(), "--no-lcm", "--lockstep", "--tum", (folder.path() / "out.tum").string()});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("would be empty: the recording has no images"), std::string::npos)
      << result.error;
  EXPECT_EQ(result.out, "");
}

TEST(ReplayCommand, AMapOfAnotherPlaceFails) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto data = testing::real_data();
  const ProcessResult result =
      replay({(data / "kitti_odometry/oxts/04.csv.gz").string(), "--no-lcm", "--lockstep",
              "--configuration", "GNSS+RISS", "--map",
              (data / "maps/liechtenstein_2015-07.osm.pbf").string()});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("far outside of the map, which covers 47."), std::string::npos)
      << result.error;
  EXPECT_NE(result.error.find("no position was on a road of the map"), std::string::npos)
      << result.error;
}

TEST(ReplayCommand, TakesATableOfOxtsRowsUnderAnyNameFromAnyFolder) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const auto table = folder.path() / "to work.csv.gz";
  std::filesystem::copy(testing::real_data() / "kitti_odometry/oxts/04.csv.gz", table);
  const ProcessResult result =
      replay({table.string(), "--no-lcm", "--lockstep", "--configuration", "GNSS+RISS"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("Horizontal error "), std::string::npos) << result.out;
}

TEST(ReplayCommand, NamesAFolderThatIsNoDrive) {
  const TemporaryFolder folder;
  const ProcessResult result = replay({folder.path().string(), "--no-lcm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find(folder.path().string()), std::string::npos) << result.error;
}

TEST(ReplayCommand, SurvivesADriveWithAHole) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const auto date = folder.path() / "2011_09_26";
  const auto copy = date / "2011_09_26_drive_0013_sync";
  std::filesystem::create_directories(date);
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::drive_0013().parent_path())) {
    if (entry.is_regular_file()) std::filesystem::copy(entry, date);
  }
  std::filesystem::copy(testing::drive_0013(), copy, std::filesystem::copy_options::recursive);
  std::filesystem::remove(copy / "image_00/data/0000000050.png");
  std::filesystem::resize_file(copy / "image_01/data/0000000060.png", 1000);
  std::filesystem::resize_file(copy / "velodyne_points/data/0000000070.bin", 1001);

  const std::string file = (folder.path() / "result.json").string();
  const ProcessResult result =
      replay({copy.string(), "--no-lcm", "--lockstep", "--verbose", "--json", file});
  EXPECT_EQ(result.status, 0) << result.error;
  for (const char* name : {"0000000050.png", "0000000060.png", "0000000070.bin"}) {
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
  }
  const json r = json::parse(std::ifstream(file));
  EXPECT_EQ(r["sensors"]["camera"]["delivered"], 142);
  EXPECT_EQ(r["sensors"]["camera"]["left_out"], 2);
  EXPECT_EQ(r["sensors"]["velodyne"]["left_out"], 1);
  EXPECT_LT(r["fused"]["end_point_m"], 10.0) << "two lost images are bridged";
}

TEST(ReplayCommand, TheReportHoldsAllOfIt) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "report.html").string();
  const std::string drive = testing::drive_0013().string();
  const ProcessResult result = replay({drive, "--no-lcm", "--lockstep", "--end", "2", "--fault",
                                       "lost@imu:1:0.1", "--report", file});
  ASSERT_EQ(result.status, 0) << result.error;
  std::stringstream page;
  page << std::ifstream(file).rdbuf();
  const std::string text = page.str();
  const std::size_t verdict = text.find("VO-L-RI did not use GNSS after the start");
  EXPECT_LT(verdict, text.find("Way of the vehicle")) << "the verdict opens the page";
  for (const char* part : {"2011_09_26_drive_0013_sync", "Way of the vehicle", "stereo odometry",
                           "Error azimuth", "lost@imu:1:0.1", "camera -&gt; stereo", "NAV_STATE",
                           "Processor time", "[fusion]", "\"fused\""}) {
    EXPECT_NE(page.str().find(part), std::string::npos) << part;
  }
  const ProcessResult unwritable =
      replay({drive, "--no-lcm", "--lockstep", "--end", "1", "--report", "/nonexistent/r.html"});
  EXPECT_NE(unwritable.status, 0);
  EXPECT_NE(unwritable.error.find("/nonexistent/r.html"), std::string::npos) << unwritable.error;
}

TEST(ReplayCommand, SaysWhatWasPerhapsMeant) {
  const ProcessResult command = testing::run({testing::maploop_command(), "reply"});
  EXPECT_EQ(command.status, 2);
  EXPECT_NE(command.error.find("did you mean 'replay'"), std::string::npos) << command.error;
  const ProcessResult option = replay({"x", "--lockstp"});
  EXPECT_EQ(option.status, 2);
  EXPECT_NE(option.error.find("did you mean '--lockstep'"), std::string::npos) << option.error;
  const ProcessResult group = testing::run({testing::maploop_command(), "map"});
  EXPECT_EQ(group.status, 2);
  EXPECT_NE(group.error.find("Usage: maploop map"), std::string::npos) << group.error;
}

TEST(ReplayCommand, SaysWhatIsWrongWithItsArguments) {
  EXPECT_NE(replay({}).status, 0);
  EXPECT_NE(replay({"x", "--speed", "0"}).status, 0);
  EXPECT_NE(replay({"x", "--speed", "2", "--lockstep"}).status, 0);
  EXPECT_NE(replay({"x", "--nonsense"}).status, 0);
  const ProcessResult config = replay({"x", "--config", "/nonexistent.toml"});
  EXPECT_NE(config.status, 0);
  EXPECT_NE(config.error.find("/nonexistent.toml"), std::string::npos);
  EXPECT_EQ(replay({"--help"}).status, 0);
}

TEST(ReplayCommand, NamesTheUnknownKeyOfAConfiguration) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "bad.toml").string();
  std::ofstream(file) << "[fusion]\ngyro_nois = 1e-4\n";
  const ProcessResult result = replay({"x", "--no-lcm", "--config", file});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("bad.toml:2"), std::string::npos) << result.error;
  EXPECT_NE(result.error.find("gyro_nois"), std::string::npos) << result.error;
  EXPECT_NE(result.error.find("gyro_noise"), std::string::npos) << "says the nearest known key";
}

}  // namespace
}  // namespace maploop
