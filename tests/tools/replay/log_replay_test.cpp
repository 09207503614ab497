// Tests `maploop replay LOG`: a log of our own is replayed like the drive.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tests/tools/replay/channel_hashes.h"

namespace maploop {
namespace {

using nlohmann::json;
using testing::hashes;
using testing::ProcessResult;

ProcessResult maploop_command(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), testing::maploop_command());
  return testing::run(arguments);
}

class LogReplay : public ::testing::Test {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_DRIVE(); }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  json replay(const std::string& recording, std::vector<std::string> options) const {
    options.insert(options.begin(),
                   {"replay", recording, "--no-lcm", "--json", file("result.json")});
    const ProcessResult result = maploop_command(options);
    EXPECT_EQ(result.status, 0) << result.error;
    return json::parse(std::ifstream(file("result.json")));
  }

  static std::string refusal(const std::string& recording) {
    const ProcessResult result = maploop_command({"replay", recording, "--no-lcm", "--lockstep"});
    EXPECT_EQ(result.status, 1);
    return result.error;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(LogReplay, ALogOfRawSensorsGivesTheHashesOfTheDrive) {
  const json drive = replay(testing::drive_0013().string(),
                            {"--lockstep", "--record", file("raw.lcmlog"), "--record-raw"});
  EXPECT_EQ(hashes(drive).size(), 7u) << "raw channels go to the log alone";
  const json log = replay(file("raw.lcmlog"), {"--lockstep"});
  EXPECT_EQ(hashes(log), hashes(drive));
  EXPECT_EQ(log["sensors"]["camera"]["delivered"], drive["sensors"]["camera"]["delivered"]);
  EXPECT_EQ(log["sensors"]["velodyne"]["delivered"], drive["sensors"]["velodyne"]["delivered"]);
  EXPECT_EQ(log["fused"], drive["fused"]) << "scored alike: calibration and truth came along";
  EXPECT_EQ(log["vo"], drive["vo"]);
  EXPECT_EQ(hashes(replay(file("raw.lcmlog"), {"--speed", "4"})), hashes(drive));
}

TEST_F(LogReplay, ALogOfALogHasTheSameBytes) {
  replay(testing::drive_0013().string(),
         {"--lockstep", "--end", "3", "--record", file("a.lcmlog"), "--record-raw"});
  replay(file("a.lcmlog"), {"--lockstep", "--record", file("b.lcmlog"), "--record-raw"});
  const ProcessResult same = maploop_command({"log", "diff", file("a.lcmlog"), file("b.lcmlog")});
  EXPECT_EQ(same.status, 0) << same.out;
  for (const char* channel : {"CAMERA: same", "VELODYNE: same", "CALIBRATION: same"}) {
    EXPECT_NE(same.out.find(channel), std::string::npos) << same.out;
  }
}

TEST_F(LogReplay, WithoutImagesTheRecordedOdometryIsFused) {
  const json drive =
      replay(testing::drive_0013().string(), {"--lockstep", "--record", file("a.lcmlog")});
  const json log = replay(file("a.lcmlog"), {"--lockstep"});
  EXPECT_EQ(hashes(log), hashes(drive));
  EXPECT_EQ(log["fused"], drive["fused"]);
  EXPECT_EQ(log["sensors"]["odometry"]["delivered"], 144);
  EXPECT_EQ(log["replay"]["images"], 144);
}

TEST_F(LogReplay, TakesSnapshotsFaultsAndMomentsAsADriveDoes) {
  replay(testing::drive_0013().string(),
         {"--lockstep", "--end", "6", "--record", file("a.lcmlog")});
  const json whole = replay(file("a.lcmlog"), {"--lockstep", "--snapshot", "3:" + file("s")});
  std::map<std::string, std::string> expected;
  for (const auto& [name, channel] : whole["snapshot"]["channels"].items()) {
    if (channel["hash"] != "") expected[name] = channel["hash"];
  }
  EXPECT_EQ(expected.size(), 7u);
  EXPECT_EQ(hashes(replay(file("a.lcmlog"), {"--lockstep", "--resume", file("s")})), expected);
  const json lost = replay(file("a.lcmlog"), {"--lockstep", "--fault", "lost@imu:2:1"});
  EXPECT_NE(hashes(lost)["NAV_STATE"], hashes(whole)["NAV_STATE"]);
  const json part = replay(file("a.lcmlog"), {"--speed", "2", "--start", "2", "--end", "4"});
  EXPECT_EQ(hashes(part), hashes(replay(file("a.lcmlog"), {"--lockstep", "--end", "4"})));
}

TEST_F(LogReplay, LogsOfRunsAtDifferentSpeedsDifferInNothing) {
  const std::string drive = testing::drive_0013().string();
  replay(drive, {"--lockstep", "--end", "5", "--record", file("lockstep.lcmlog")});
  for (const char* speed : {"1", "7"}) {
    replay(drive, {"--speed", speed, "--end", "5", "--record", file("paced.lcmlog")});
    const ProcessResult same =
        maploop_command({"log", "diff", file("lockstep.lcmlog"), file("paced.lcmlog")});
    EXPECT_EQ(same.status, 0) << same.out;
    EXPECT_NE(same.out.find("NAV_STATE: same, "), std::string::npos) << same.out;
  }
  replay(drive, {"--lockstep", "--end", "5", "--seed", "2", "--record", file("other.lcmlog")});
  const ProcessResult other =
      maploop_command({"log", "diff", file("lockstep.lcmlog"), file("other.lcmlog")});
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.out.find("GNSS_FIX: different"), std::string::npos) << other.out;
}

TEST_F(LogReplay, ALogIsNotReplacedByItsOwnReplay) {
  replay(testing::drive_0013().string(),
         {"--lockstep", "--end", "1", "--record", file("a.lcmlog")});
  const auto size = std::filesystem::file_size(file("a.lcmlog"));
  EXPECT_NE(maploop_command({"replay", file("a.lcmlog"), "--record", file("a.lcmlog")}).status, 0);
  EXPECT_EQ(std::filesystem::file_size(file("a.lcmlog")), size);
}

TEST_F(LogReplay, TheLastPassOfALoopIsLikeTheFirst) {
  const std::string drive = testing::drive_0013().string();
  EXPECT_EQ(hashes(replay(drive, {"--lockstep", "--end", "2", "--loop", "3"})),
            hashes(replay(drive, {"--lockstep", "--end", "2"})));
  EXPECT_EQ(hashes(replay(drive, {"--speed", "4", "--end", "2", "--loop", "2"})),
            hashes(replay(drive, {"--lockstep", "--end", "2"})));
}

TEST_F(LogReplay, CompressedLogsAreReadToo) {
  replay(testing::drive_0013().string(),
         {"--lockstep", "--end", "3", "--record", file("a.lcmlog")});
  ASSERT_EQ(maploop_command({"log", "merge", file("a.lcmlog"), "-o", file("a.lcmlog.gz")}).status,
            0);
  EXPECT_EQ(hashes(replay(file("a.lcmlog.gz"), {"--lockstep"})),
            hashes(replay(file("a.lcmlog"), {"--lockstep"})));
}

TEST_F(LogReplay, WhatCannotBeReplayedIsRefusedWithItsReason) {
  replay(testing::drive_0013().string(),
         {"--lockstep", "--end", "2", "--record", file("a.lcmlog")});
  EXPECT_EQ(maploop_command({"log", "split", file("a.lcmlog"), "--channels", "IMU|VO", "-o",
                             file("uncalibrated.lcmlog")})
                .status,
            0);
  EXPECT_NE(refusal(file("uncalibrated.lcmlog")).find("contains no calibration"),
            std::string::npos);
  EXPECT_EQ(maploop_command({"log", "split", file("a.lcmlog"), "--channels", "NAV_STATE", "-o",
                             file("states.lcmlog")})
                .status,
            0);
  EXPECT_NE(refusal(file("states.lcmlog")).find("no messages of sensors"), std::string::npos);
  std::filesystem::resize_file(file("a.lcmlog"), std::filesystem::file_size(file("a.lcmlog")) - 9);
  const std::string damaged = refusal(file("a.lcmlog"));
  EXPECT_NE(damaged.find("damaged"), std::string::npos) << damaged;
  EXPECT_NE(damaged.find("log recover"), std::string::npos) << damaged;
  std::ofstream(file("text")) << "no log";
  EXPECT_NE(refusal(file("text")).find("text"), std::string::npos);
  EXPECT_NE(refusal(file("nowhere")).find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace maploop
