// `maploop live` as its user runs it, with `maploop send` for sensors.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using nlohmann::json;
using testing::Process;
using testing::ProcessResult;
using testing::TemporaryFolder;

// Ports of this test alone.
constexpr const char* endpoints = R"(
velodyne = "udp://:42368"
velodyne_model = "HDL-64E"
velodyne_calibration = "db.xml"
imu = "udp://:43000"
gnss = "udp://:43001"
)";

std::vector<std::string> send_command(std::vector<std::string> options) {
  options.insert(options.begin(), {MAPLOOP_COMMAND, "send", testing::drive_0013().string()});
  return options;
}

std::filesystem::path write_config(const TemporaryFolder& folder) {
  const auto file = folder.path() / "live.toml";
  std::ofstream(file) << "configuration = \"GNSS+VO-L-RI\"\n[live]\ncalibration = \""
                      << testing::drive_0013().parent_path().string() << "\"\n"
                      << endpoints;
  return file;
}

TEST(LiveCommand, DrivesOnWhatADriveSends) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const auto in = [&](const char* name) { return (folder.path() / name).string(); };
  ASSERT_EQ(testing::run(send_command({"--calibration", in("db.xml")})).status, 0);
  Process live({MAPLOOP_COMMAND, "live", write_config(folder).string(), "--no-lcm", "--seconds",
                "6", "--json", in("live.json"), "--tum", in("live.tum"), "--record",
                in("live.lcmlog")});
  const ProcessResult sent =
      testing::run(send_command({"--velodyne", "udp://:42368", "--imu", "udp://:43000", "--gnss",
                                 "udp://:43001", "--truth", in("truth.tum"), "--seconds", "4"}));
  EXPECT_EQ(sent.status, 0) << sent.error;
  const ProcessResult result = live.wait();
  ASSERT_EQ(result.status, 0) << result.error;
  const json said = json::parse(std::ifstream(in("live.json")));
  EXPECT_GT(said["sensors"]["velodyne"]["delivered"], 20) << result.out;
  EXPECT_GT(said["sensors"]["imu"]["delivered"], 20);
  EXPECT_GE(said["sensors"]["gnss"]["delivered"], 2);
  for (const char* name : {"velodyne", "imu", "gnss"}) {
    EXPECT_EQ(said["sensors"][name]["left_out"], 0) << name;
    EXPECT_EQ(said["live"][name]["connections"], 1) << name;
    EXPECT_EQ(said["live"][name]["clock"]["jumps"], 0) << name;
  }
  EXPECT_GT(said["channels"]["NAV_STATE"]["count"], 200);
  EXPECT_GT(said["channels"]["LIDAR_ODOMETRY"]["count"], 10);
  const ProcessResult log = testing::run({MAPLOOP_COMMAND, "log", "info", in("live.lcmlog")});
  EXPECT_EQ(log.status, 0) << log.error;
  EXPECT_NE(log.out.find("NAV_STATE"), std::string::npos);
}

TEST(LiveCommand, EndsAtCtrlCWithItsTableThoughNothingIsThere) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  ASSERT_EQ(
      testing::run(send_command({"--calibration", (folder.path() / "db.xml").string()})).status, 0);
  Process live({MAPLOOP_COMMAND, "live", write_config(folder).string(), "--no-lcm"});
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  live.send_signal(SIGINT);
  const ProcessResult result = live.wait();
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("imu: silent since the start"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("udp://:42368"), std::string::npos) << result.out;
}

TEST(LiveCommand, RefusesAConfigurationWithoutASensor) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "empty.toml";
  std::ofstream(file) << "";
  const ProcessResult result = testing::run({MAPLOOP_COMMAND, "live", file.string(), "--no-lcm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("names no live sensor"), std::string::npos) << result.error;
}

}  // namespace
}  // namespace maploop
