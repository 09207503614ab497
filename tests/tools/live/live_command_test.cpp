// Tests `maploop live` as users run it, with `maploop send` instead of sensors.
#include <csignal>
#include <regex>

#include "tests/sensors/live/lines.h"
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

// Ports of this test only, because other tests may run at the same time.
struct Ports {
  int camera = free_port(), velodyne = free_port(), imu = free_port(), gnss = free_port();
};

std::string udp(int port) {
  return "udp://:" + std::to_string(port);
}

class LiveCommand : public DriveTest {
 protected:
  // Sends the drive.
  static ProcessResult send(Words options) {
    options.insert(options.begin(), {"send", drive()});
    return run_maploop(options);
  }

  // Starts a live run on these ports, with its log.
  std::unique_ptr<Process> started(const Ports& ports, Words options) {
    EXPECT_EQ(send({"--calibration", file("db.xml")}).status, 0);
    EXPECT_EQ(run({maploop_command(), "vehicle", "convert", "kitti",
                   drive_0013().parent_path().string(), file("kitti.toml")})
                  .status,
              0);
    const std::string config = write(
        "live.toml",
        "configuration = \"GNSS+VO-L-RI\"\n[vehicle]\nfile = \"kitti.toml\"\n[vehicle.lidar]\n"
        "calibration = \"db.xml\"\n[live]\ncamera_left = \"udpsrc address=127.0.0.1 port=" +
            std::to_string(ports.camera) +
            " buffer-size=8388608 caps=application/x-rtp,media=application,"
            "clock-rate=90000,encoding-name=X-GST ! rtpgstdepay\"\nvelodyne = \"" +
            udp(ports.velodyne) + "\"\nimu = \"" + udp(ports.imu) + "\"\ngnss = \"" +
            udp(ports.gnss) + "\"\n");
    options.insert(options.begin(), {maploop_command(), "live", config, "--no-lcm", "--record",
                                     file("live.lcmlog")});
    return std::make_unique<Process>(options);
  }
};

TEST_F(LiveCommand, DrivesOnWhatADriveSends) {
  const Ports driving;
  const auto live =
      started(driving, {"--seconds", "60", "--json", file("live.json"), "--tum", file("live.tum")});
  ASSERT_TRUE(comes_to_contain(file("live.lcmlog"), "HEALTH")) << "it listens";
  const ProcessResult sent =
      send({"--camera",
            "rtpgstpay config-interval=1 mtu=60000 ! udpsink host=127.0.0.1 port=" +
                std::to_string(driving.camera),
            "--velodyne", udp(driving.velodyne), "--imu", udp(driving.imu), "--gnss",
            udp(driving.gnss), "--truth", file("truth.tum"), "--seconds", "4"});
  EXPECT_EQ(sent.status, 0) << sent.error;
  live->send_signal(SIGINT);
  const ProcessResult result = live->wait();
  ASSERT_EQ(result.status, 0) << result.error;
  const json said = read_json(file("live.json"));
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
  const ProcessResult log = run_maploop({"log", "info", file("live.lcmlog")});
  EXPECT_EQ(log.status, 0) << log.error;
  EXPECT_THAT(log.out, HasSubstr("NAV_STATE"));
}

TEST_F(LiveCommand, EndsAtCtrlCAndSaysThatNothingWasThere) {
  const Ports silent;
  const auto live = started(silent, {"--verbose"});
  EXPECT_TRUE(comes_to_contain(file("live.lcmlog"), "imu: silent since the start"));
  live->send_signal(SIGINT);
  const ProcessResult result = live->wait();
  EXPECT_EQ(result.status, 1) << result.error;
  EXPECT_THAT(result.error, HasSubstr("no sensor has delivered anything"));
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("imu: silent since the start"), HasSubstr(udp(silent.velodyne))));
  const ProcessResult timed =
      run_maploop({"live", file("live.toml"), "--no-lcm", "--seconds", "1"});
  EXPECT_EQ(timed.status, 1) << timed.error;
  EXPECT_THAT(timed.out, HasSubstr("no position."));
}

using LiveConfiguration = CommandTest;

TEST_F(LiveConfiguration, WithoutASensorIsRefused) {
  const ProcessResult result = run_maploop({"live", write("empty.toml", ""), "--no-lcm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("has no live sensor"));
}

}  // namespace
}  // namespace maploop
