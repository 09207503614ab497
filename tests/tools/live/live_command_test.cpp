// Tests `maploop live` as users run it, with `maploop send` instead of sensors.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/sensors/live/lines.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using nlohmann::json;
using testing::Process;
using testing::ProcessResult;
using testing::TemporaryFolder;

// Ports of this test only, because other tests may run at the same time.
struct Ports {
  int camera = testing::free_port(), velodyne = testing::free_port(), imu = testing::free_port(),
      gnss = testing::free_port();
};

std::string udp(int port) {
  return "udp://:" + std::to_string(port);
}

std::vector<std::string> send_command(std::vector<std::string> options) {
  options.insert(options.begin(),
                 {testing::maploop_command(), "send", testing::drive_0013().string()});
  return options;
}

std::filesystem::path write_config(const TemporaryFolder& folder, const Ports& ports) {
  const auto file = folder.path() / "live.toml";
  std::ofstream(file) << "configuration = \"GNSS+VO-L-RI\"\n[live]\ncalibration = \""
                      << testing::drive_0013().parent_path().string()
                      << "\"\ncamera_left = \"udpsrc address=127.0.0.1 port=" << ports.camera
                      << " buffer-size=8388608 caps=application/x-rtp,media=application,"
                         "clock-rate=90000,encoding-name=X-GST ! rtpgstdepay\"\nvelodyne = \""
                      << udp(ports.velodyne)
                      << "\"\nvelodyne_model = \"HDL-64E\"\nvelodyne_calibration = \"db.xml\"\n"
                      << "imu = \"" << udp(ports.imu) << "\"\ngnss = \"" << udp(ports.gnss)
                      << "\"\n";
  return file;
}

TEST(LiveCommand, DrivesOnWhatADriveSends) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const Ports driving;
  const auto in = [&](const char* name) { return (folder.path() / name).string(); };
  ASSERT_EQ(testing::run(send_command({"--calibration", in("db.xml")})).status, 0);
  Process live({testing::maploop_command(), "live", write_config(folder, driving).string(),
                "--no-lcm", "--seconds", "60", "--json", in("live.json"), "--tum", in("live.tum"),
                "--record", in("live.lcmlog")});
  ASSERT_TRUE(testing::comes_to_contain(in("live.lcmlog"), "HEALTH")) << "it listens";
  const ProcessResult sent = testing::run(
      send_command({"--camera",
                    "rtpgstpay config-interval=1 mtu=60000 ! udpsink host=127.0.0.1 port=" +
                        std::to_string(driving.camera),
                    "--velodyne", udp(driving.velodyne), "--imu", udp(driving.imu), "--gnss",
                    udp(driving.gnss), "--truth", in("truth.tum"), "--seconds", "4"}));
  EXPECT_EQ(sent.status, 0) << sent.error;
  live.send_signal(SIGINT);
  const ProcessResult result = live.wait();
  ASSERT_EQ(result.status, 0) << result.error;
  const json said = json::parse(std::ifstream(in("live.json")));
  EXPECT_GT(said["sensors"]["velodyne"]["delivered"], 20) << result.out;
  EXPECT_GT(said["sensors"]["imu"]["delivered"], 20);
  EXPECT_GE(said["sensors"]["gnss"]["delivered"], 2);
  // Images can be decoded after the next caps, which are sent every second.
  EXPECT_GT(said["sensors"]["camera"]["delivered"], 10);
  for (const char* name : {"camera", "velodyne", "imu", "gnss"}) {
    EXPECT_EQ(said["sensors"][name]["left_out"], 0) << name;
    EXPECT_EQ(said["live"][name]["connections"], 1) << name;
  }
  // A sender that the machine delays by half a second looks like a clock that jumps.
  for (const char* name : {"velodyne", "imu", "gnss"}) {
    std::smatch late;
    ASSERT_TRUE(std::regex_search(sent.out, late,
                                  std::regex(std::string(name) + ".* up to (\\d+) ms late")))
        << sent.out;
    if (std::stoi(late[1]) < 400) {
      EXPECT_EQ(said["live"][name]["clock"]["jumps"], 0) << name;
    }
  }
  EXPECT_GT(said["channels"]["NAV_STATE"]["count"], 200);
  EXPECT_GT(said["channels"]["VO"]["count"], 10);
  EXPECT_GT(said["channels"]["LIDAR_ODOMETRY"]["count"], 10);
  const ProcessResult log =
      testing::run({testing::maploop_command(), "log", "info", in("live.lcmlog")});
  EXPECT_EQ(log.status, 0) << log.error;
  EXPECT_NE(log.out.find("NAV_STATE"), std::string::npos);
}

TEST(LiveCommand, EndsAtCtrlCAndSaysThatNothingWasThere) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  ASSERT_EQ(
      testing::run(send_command({"--calibration", (folder.path() / "db.xml").string()})).status, 0);
  const Ports silent;
  const auto log = folder.path() / "log";
  Process live({testing::maploop_command(), "live", write_config(folder, silent).string(),
                "--no-lcm", "--verbose", "--record", log.string()});
  EXPECT_TRUE(testing::comes_to_contain(log, "imu: silent since the start"));
  live.send_signal(SIGINT);
  const ProcessResult result = live.wait();
  EXPECT_EQ(result.status, 1) << result.error;
  EXPECT_NE(result.error.find("no sensor has delivered anything"), std::string::npos)
      << result.error;
  EXPECT_NE(result.out.find("imu: silent since the start"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(udp(silent.velodyne)), std::string::npos) << result.out;
  const auto config = (folder.path() / "live.toml").string();
  const ProcessResult timed =
      testing::run({testing::maploop_command(), "live", config, "--no-lcm", "--seconds", "1"});
  EXPECT_EQ(timed.status, 1) << timed.error;
  EXPECT_NE(timed.out.find("no position."), std::string::npos) << timed.out;
}

TEST(LiveCommand, RefusesAConfigurationWithoutASensor) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "empty.toml";
  std::ofstream(file) << "";
  const ProcessResult result =
      testing::run({testing::maploop_command(), "live", file.string(), "--no-lcm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.error.find("has no live sensor"), std::string::npos) << result.error;
}

}  // namespace
}  // namespace maploop
