// Tests what `maploop doctor RECORDING` says of real recordings, and that bags are replayed.
#include "tests/support/command_test.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using namespace testing;

std::string bag(const std::string& name) {
  return real_data() / "bags" / name;
}

json report_of(const std::string& recording, const Words& options = {}) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "report.json";
  Words command{maploop_command(), "doctor", recording, "--json", file};
  command.insert(command.end(), options.begin(), options.end());
  const ProcessResult result = run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  json report = read_json(file);
  for (const json& sensor : report.at("sensors")) report[sensor.at("sensor")] = sensor;
  return report;
}

std::vector<std::string> sentences(const json& report) {
  return report.at("sentences");
}

TEST(DoctorOfARecording, SaysWhatABagContains) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const json report = report_of(bag("kitti_0013/kitti13_zstd.mcap"));
  EXPECT_EQ(report["camera"]["samples"], 3);
  EXPECT_NEAR(report["lidar"]["rate_hz"], 9.66, 0.05);
  EXPECT_EQ(report["imu"]["samples"], 4);
  EXPECT_EQ(report["gnss"]["left_out"], 0);
  EXPECT_THAT(sentences(report), Contains(HasSubstr("/gps/vel")));
  EXPECT_THAT(sentences(report), Contains("A replay can combine camera, lidar, imu, gnss."));
  EXPECT_THAT(sentences(report), Contains(HasSubstr("Next: maploop replay")));
}

TEST(DoctorOfARecording, SaysWhatCannotBeDoneWithoutGnss) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const json report = report_of(bag("kitti_0013/kitti13_zstd.mcap"), {"--topic", "gnss=none"});
  EXPECT_FALSE(report.contains("gnss"));
  EXPECT_THAT(sentences(report), Contains(HasSubstr("maploop odometry")));
}

TEST(DoctorOfARecording, TablesHaveNoTopics) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ProcessResult result =
      run({maploop_command(), "doctor",
           real_data() / "cars/oakville/parking-lot-figure8-nominal-001", "--topic", "imu=none"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("--topic names topics of a recording of ROS"));
}

TEST(DoctorOfARecording, NamesPausesAndSamplesThatAreLeftOut) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const json report = report_of(real_data() / "cars/oakville/parking-lot-figure8-nominal-001");
  EXPECT_NEAR(report["imu"]["rate_hz"], 99.5, 0.1);
  EXPECT_THAT(sentences(report), Contains(HasSubstr("the mount was not yet known")));
  EXPECT_THAT(sentences(report), Contains(HasSubstr("reference pauses for 18.51 s")));
}

TEST(DoctorOfARecording, WritesAPageWithTimeLines) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const std::string page = folder.path() / "page.html";
  report_of(real_data() / "cars/oakville/parking-lot-figure8-nominal-001", {"--html", page});
  const std::string html = read_file(page);
  EXPECT_THAT(html, HasSubstr("reference pauses for 18.51 s"));
  const auto begin = html.find('[', html.find("id=\"plots\""));
  const json plots = json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  ASSERT_EQ(plots.size(), 2U);
  const json& lines = plots[0].at("lines");
  ASSERT_EQ(lines.at(0).at("name"), "imu");
  const auto& imu = lines[0].at("y");
  ASSERT_EQ(imu.size(), 300U);
  EXPECT_EQ(imu[100], 0.0) << "Its mount is not yet known.";
  for (std::size_t i = 260; i < 295; ++i) EXPECT_NEAR(imu[i].get<double>(), 100.0, 10.0) << i;
  EXPECT_THAT(lines.back().at("name"), "reference");
  EXPECT_THAT(lines.back().at("y"), Contains(0.0)) << "It pauses.";
}

TEST(DoctorOfARecording, APageOfNoRecordingIsRefused) {
  const ProcessResult result = run({maploop_command(), "doctor", "--html", "page.html"});
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.error, HasSubstr("--html requires RECORDING"));
}

TEST(DoctorOfARecording, FailsWithTheReason) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ProcessResult result =
      run({maploop_command(), "doctor", bag("recorded/imu_sparkfun_razor.bag")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("has only an inertial unit, /imu/data_raw"));
}

TEST(ReplayOfABag, HasAPosition) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ProcessResult result = run(
      {maploop_command(), "replay", bag("recorded/pj_tilt_laser.bag"), "--lockstep", "--no-lcm"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("47.376"));
  EXPECT_THAT(result.error, HasSubstr("/velocity"));
}

TEST(OdometryOfABag, RunsOnItsImagesAndClouds) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ProcessResult result =
      run({maploop_command(), "odometry", bag("kitti_0013/kitti13_ros1_bz2.bag"), "--lidar"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("ok: 1"));  // the first pair of images has no motion
  const ProcessResult visual =
      run({maploop_command(), "odometry", bag("kitti_0013/kitti13_ros1_bz2.bag")});
  EXPECT_EQ(visual.status, 0) << visual.error;
  EXPECT_THAT(visual.out, HasSubstr("ok: 2"));
  const ProcessResult none =
      run({maploop_command(), "odometry", bag("recorded/pj_tilt_laser.bag"), "--lidar"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.error, HasSubstr("pj_tilt_laser.bag' has no scans of a LiDAR"));
}

using DoctorOfADrive = DriveTest;

TEST_F(DoctorOfADrive, StampsOfAllSensorsAgree) {
  const json report = report_of(drive());
  ASSERT_EQ(report.at("offsets").size(), 3U) << "of camera, LiDAR and inertial unit";
  for (const json& offset : report.at("offsets")) {
    EXPECT_TRUE(offset["found"].get<bool>()) << offset;
    EXPECT_LT(std::abs(offset["offset_ms"].get<double>()), 15.0) << offset;
    EXPECT_GT(offset["correlation"].get<double>(), 0.9) << offset;
  }
  EXPECT_THAT(report.at("sentences").dump(), Not(HasSubstr("The stamps of")));
  EXPECT_THAT(report.at("sentences").dump(), Not(HasSubstr("cut off")));
}

TEST_F(DoctorOfADrive, AUnitWhoseDelayIsWrongIsEarlier) {
  const std::string config = write("a.toml", "[vehicle.imu]\ndelay = 0.2\n");
  const json report = report_of(drive(), {"--config", config});
  EXPECT_NEAR(report.at("offsets").at(0)["offset_ms"].get<double>(), -140.0, 20.0);
  EXPECT_THAT(report.at("sentences").dump(), HasSubstr("ms earlier than those of camera"));
  EXPECT_THAT(report.at("sentences").dump(), HasSubstr("maploop calibrate extrinsics"));
}

}  // namespace
}  // namespace maploop
