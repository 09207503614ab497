// Tests maploop calibrate extrinsics on recorded drives.
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

class ExtrinsicsOfDrive : public DriveTest {
 protected:
  // Returns the values that the command finds, as "vehicle.camera.yaw".
  json found(const std::string& recording, Words options) {
    options.insert(options.begin(), {"calibrate", "extrinsics", recording, "--toml",
                                     file("found.toml"), "--json", file("found.json")});
    const ProcessResult result = run_maploop(options);
    EXPECT_EQ(result.status, 0) << result.error;
    const json report = read_json(file("found.json"));
    json values;
    for (const json& v : report["values"])
      values[v["table"].get<std::string>() + '.' + v["key"].get<std::string>()] = v;
    return values;
  }
};

// Five degrees and 50 ms beside KITTI's own calibration, of which the reader's preset is 60 ms, and
// the LiDAR 0.3 m on each axis.
TEST_F(ExtrinsicsOfDrive, FindsKittisCalibrationFromFiveDegreesAndFiftyMillisecondsBesideIt) {
  const std::string off = write("off.toml",
                                "[vehicle.camera]\nforward = 1.0833\nleft = -0.3099\nup = 0.7299\n"
                                "roll = 2.643\npitch = 3.369\nyaw = 2.946\n"
                                "[vehicle.lidar]\nforward = 0.5\nleft = 0.0\nup = 1.1\n"
                                "roll = -3.736\npitch = -3.004\nyaw = 2.930\n"
                                "[vehicle.imu]\ndelay = 0.11\n");
  const json v = found(drive(), {"--config", off});
  const auto expect = [&](const char* key, double kitti, double tolerance) {
    ASSERT_TRUE(v.contains(key)) << key;
    EXPECT_NEAR(v[key]["value"].get<double>(), kitti, tolerance) << key;
    EXPECT_TRUE(v[key]["written"].get<bool>()) << key;
  };
  expect("vehicle.camera.roll", -0.244, 0.35);
  expect("vehicle.camera.pitch", 0.482, 0.4);
  expect("vehicle.camera.yaw", 0.059, 0.5);
  expect("vehicle.lidar.roll", -0.849, 0.4);  // one sigma is 0.28
  expect("vehicle.lidar.pitch", -0.117, 0.5);
  expect("vehicle.lidar.yaw", 0.043, 0.5);
  expect("vehicle.imu.delay", 0.060, 0.012);
  EXPECT_FALSE(v["vehicle.camera.forward"]["written"].get<bool>())
      << "the street is nearly straight";
  // The LiDAR is placed against the camera by what both see.
  expect("vehicle.lidar.forward", 0.811, 0.04);
  expect("vehicle.lidar.left", -0.307, 0.05);
  expect("vehicle.lidar.up", 0.803, 0.03);
  // The LiDAR triggers the cameras, whose stamps are 16.7 ms later than the middle of the scan.
  expect("vehicle.lidar.delay", 0.0, 1e-6);
  expect("vehicle.camera.delay", 0.0167, 0.008);
  EXPECT_EQ(run_maploop({"vehicle", "check", file("found.toml")}).status, 0);
  EXPECT_THAT(read_file(file("found.toml")), HasSubstr("yaw_sigma"));
}

TEST_F(ExtrinsicsOfDrive, ThreeSecondsAreTooShortAndItSaysSo) {
  const ProcessResult result =
      run_maploop({"calibrate", "extrinsics", drive(), "--end", "3", "--toml", file("found.toml")});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("fewer than 6 s"));
}

using ExtrinsicsCommand = CommandTest;

TEST_F(ExtrinsicsCommand, FindsTheMountOfAnotherCar) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto folder = real_data() / "cars/oakville/urban-stop-go-tight-turns-nominal-001";
  const ProcessResult result = run_maploop({"calibrate", "extrinsics", folder.string(), "--toml",
                                            file("found.toml"), "--json", file("found.json")});
  ASSERT_EQ(result.status, 0) << result.error;
  const json report = read_json(file("found.json"));
  std::map<std::string, double> angle;
  for (const json& v : report["values"]) angle[v["key"]] = v["value"];
  EXPECT_NEAR(angle["yaw"], 266.35 - 360.0, 2.0) << "the receiver's own";
  EXPECT_NEAR(angle["roll"], -1.88, 2.0);
}

TEST_F(ExtrinsicsCommand, ARecordingOfOneSensorHasNothingToCompare) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto capture = real_data() / "velodyne/vlp16_moving_car.pcap";
  const ProcessResult result =
      run_maploop({"calibrate", "extrinsics", capture.string(), "--toml", file("found.toml")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("no two sensors to compare"));
  EXPECT_FALSE(std::filesystem::exists(file("found.toml")));
}

}  // namespace
}  // namespace maploop
