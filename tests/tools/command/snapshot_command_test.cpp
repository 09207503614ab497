// Tests `maploop replay --snapshot` and `--resume` as users run them, on the recorded drive.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
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

class SnapshotCommand : public ::testing::Test {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_DRIVE(); }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  static ProcessResult maploop(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), testing::maploop_command());
    return testing::run(arguments);
  }

  json replay(std::vector<std::string> options) const {
    options.insert(options.begin(), {"replay", testing::drive_0013().string(), "--no-lcm", "--json",
                                     file("result.json")});
    const ProcessResult result = maploop(options);
    EXPECT_EQ(result.status, 0) << result.error;
    return json::parse(std::ifstream(file("result.json")));
  }

  std::string refusal(std::vector<std::string> options) const {
    options.insert(options.begin(), {"replay", testing::drive_0013().string(), "--no-lcm"});
    const ProcessResult result = maploop(options);
    EXPECT_NE(result.status, 0);
    return result.error;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(SnapshotCommand, AResumedRunHasTheHashesOfTheWholeRunFromThereOn) {
  // 8.03 s is between an image and its result, which is not yet available then.
  const json whole = replay({"--lockstep", "--snapshot", "8.03:" + file("a.snapshot")});
  const auto expected = hashes(whole["snapshot"]);
  EXPECT_EQ(expected.size(), 7u);
  EXPECT_GT(whole["snapshot"]["channels"]["VO"]["count"], 60);
  EXPECT_EQ(hashes(replay({"--lockstep", "--resume", file("a.snapshot")})), expected);
  EXPECT_EQ(hashes(replay({"--speed", "2", "--resume", file("a.snapshot")})), expected);
  EXPECT_EQ(hashes(whole), hashes(replay({"--lockstep"}))) << "taking it changed a bit";
}

TEST_F(SnapshotCommand, ARealTimeRunTakesTheSameSnapshotWithoutALoss) {
  replay({"--lockstep", "--snapshot", "3:" + file("lockstep.snapshot"), "--end", "5"});
  const json paced = replay({"--snapshot", "3:" + file("paced.snapshot"), "--end", "5"});
  EXPECT_EQ(paced["replay"]["lost"], 0);
  const auto bytes = [](const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  EXPECT_EQ(bytes(file("paced.snapshot")), bytes(file("lockstep.snapshot")));
}

TEST_F(SnapshotCommand, TheLogsAgreeFromTheSnapshotOn) {
  const json whole = replay(
      {"--lockstep", "--snapshot", "8:" + file("a.snapshot"), "--record", file("whole.lcmlog")});
  replay({"--lockstep", "--resume", file("a.snapshot"), "--record", file("resumed.lcmlog")});
  // The start is later than the snapshot by a microsecond, the resolution of a log's clock.
  const std::string start = std::to_string(whole["snapshot"]["at_s"].get<double>() + 1e-6);
  ASSERT_EQ(
      maploop({"log", "split", file("whole.lcmlog"), "--start", start, "-o", file("tail.lcmlog")})
          .status,
      0);
  const ProcessResult same =
      maploop({"log", "diff", file("tail.lcmlog"), file("resumed.lcmlog"), "--channels",
               "NAV_STATE|VO|LIDAR_ODOMETRY|ODOMETRY|IMU|GNSS_FIX|TRUTH"});
  EXPECT_EQ(same.status, 0) << same.out;
  EXPECT_NE(same.out.find("NAV_STATE: same"), std::string::npos) << same.out;
}

TEST_F(SnapshotCommand, WhatDoesNotFitIsRefusedWithItsReason) {
  replay({"--lockstep", "--end", "2", "--snapshot", "1:" + file("a.snapshot")});
  EXPECT_NE(refusal({"--resume", file("a.snapshot"), "--seed", "5"}).find("gnss.seed = 1"),
            std::string::npos);
  std::ofstream(file("other.toml")) << "[stereo]\nmax_speed = 50.0\n";
  const std::string stereo =
      refusal({"--resume", file("a.snapshot"), "--config", file("other.toml")});
  EXPECT_NE(stereo.find("max_speed"), std::string::npos) << stereo;
  EXPECT_NE(stereo.find("a.snapshot"), std::string::npos) << stereo;
  std::filesystem::resize_file(file("a.snapshot"), 5000);
  EXPECT_NE(refusal({"--resume", file("a.snapshot")}).find("it is cut"), std::string::npos);
  EXPECT_NE(refusal({"--resume", file("nowhere")}).find("nowhere"), std::string::npos);
}

TEST_F(SnapshotCommand, ASnapshotThatIsNotTakenIsAnError) {
  EXPECT_NE(refusal({"--lockstep", "--end", "1", "--snapshot", "60:" + file("a.snapshot")})
                .find("did not come to 60 s"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("a.snapshot")));
  EXPECT_NE(refusal({"--snapshot", "soon:a"}).find("SECONDS:FILE"), std::string::npos);
  EXPECT_NE(refusal({"--snapshot", "-1:a"}).find("SECONDS:FILE"), std::string::npos);
  EXPECT_NE(refusal({"--snapshot", "5"}).find("SECONDS:FILE"), std::string::npos);
}

}  // namespace
}  // namespace maploop
