#include "runtime/vehicle/config/vehicle_config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "runtime/core/config.h"
#include "runtime/vehicle/graph/graph.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path shipped =
    maploop::testing::source("runtime/vehicle/config/maploop.toml");

VehicleConfig load_text(const std::string& text) {
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "test.toml";
  std::ofstream(file) << text;
  return load_vehicle_config(file);
}

std::set<std::string> keys(const std::string& toml) {
  std::set<std::string> all;
  std::istringstream in(toml);
  std::string table;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('[')) table = line;
    if (line.starts_with("# ")) line.erase(0, 2);  // a key of the vehicle
    const auto equals = line.find(" = ");
    if (equals != std::string::npos && line.find(' ') == equals) {
      all.insert(table + line.substr(0, equals));
    }
  }
  return all;
}

TEST(VehicleConfig, TheShippedFileHasEveryKeyWithItsDefault) {
  EXPECT_EQ(to_toml(load_vehicle_config(shipped)), to_toml(VehicleConfig{}));
  std::ostringstream text;
  text << std::ifstream(shipped).rdbuf();
  EXPECT_EQ(keys(text.str()), keys(to_toml(VehicleConfig{})));
}

TEST(VehicleConfigSetting, StandsInPlaceOfTheFile) {
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "test.toml";
  std::ofstream(file) << "configuration = \"GNSS+RISS\"\nimu_grade = \"mems\"\n"
                         "[fusion]\nmin_course_speed = 3.0\n[map]\nfile = \"roads.osm\"\n";
  const VehicleConfig config = load_vehicle_config(
      file, {"configuration=GNSS+VO-RI", "imu_grade = tactical", "fusion.min_course_speed=2",
             "fusion.gyro_noise=1e-3", "map.rules=rules", "vehicle.camera.forward=1.5"});
  EXPECT_EQ(config.configuration, "GNSS+VO-RI");
  EXPECT_TRUE(config.fusion.use_odometry_speed);
  EXPECT_FALSE(config.fusion.use_wheel_speed);
  EXPECT_EQ(config.fusion.accelerometer_turn_on_sigma,
            fusion::FusionParameters{}.accelerometer_turn_on_sigma)
      << "the file's grade leaves nothing behind";
  EXPECT_EQ(config.fusion.min_course_speed, 2.0);
  EXPECT_EQ(config.fusion.gyro_noise, 1e-3);
  EXPECT_EQ(config.map.file, (folder.path() / "roads.osm").string());
  EXPECT_EQ(config.map.rules, "rules") << "from the current folder";
  EXPECT_TRUE(config.is_given("vehicle.camera", "forward"));
}

TEST(VehicleConfigSetting, NeedsNoFile) {
  EXPECT_EQ(load_vehicle_config({}, {"gnss.seed=7"}).gnss.seed, 7u);
}

TEST(VehicleConfigSetting, ThatIsWrongIsNamed) {
  const auto said = [](const char* setting) {
    return error_of<runtime::ConfigError>([&] { load_vehicle_config({}, {setting}); });
  };
  EXPECT_THAT(said("fusion.gyro_noise"),
              HasSubstr("--set fusion.gyro_noise: write TABLE.KEY=VALUE"));
  EXPECT_THAT(said("fusion.gyro_nose=1"), HasSubstr("gyro_noise"));
  EXPECT_THAT(said("fusion.gyro_noise=-1"), HasSubstr("fusion.gyro_noise"));
  EXPECT_THAT(said("configuration=all"), HasSubstr("no configuration is called 'all'"));
  EXPECT_THAT(said("=3"), HasSubstr("--set =3"));
  EXPECT_THAT(said("fusion.gyro_noise='"), HasSubstr("--set fusion.gyro_noise='"));
}

TEST(VehicleConfig, WhatIsWrittenHasNoPasswords) {
  VehicleConfig config;
  config.live.gnss = "ntrip://me:secret@host/RECEIVER";
  config.live.corrections = "ntrips://me:secret@host/CORRECTIONS";
  config.live.camera_left = "rtspsrc location=rtsp://me:secret@host/left";
  const std::string text = to_toml(config);
  EXPECT_THAT(text, Not(HasSubstr("secret")));
  EXPECT_THAT(text, HasSubstr("corrections = \"ntrips://***@host/CORRECTIONS\""));
}

TEST(VehicleConfig, NoCarIsADefaultAndTheFileKnowsBetterThanTheRecording) {
  const VehicleConfig neutral;
  EXPECT_EQ(neutral.fusion.rear_axle_distance, 0.0);
  EXPECT_EQ(neutral.fusion.climb_offset, 0.0);
  EXPECT_EQ(neutral.lidar.elevation_correction, 0.0);
  VehicleCalibration car;
  car.rear_axle_distance = 0.25;
  car.climb_offset = 0.0084;
  car.climb_offset_sigma = 0.0087;
  car.beam_elevation = 0.0036;
  VehicleConfig config = load_text("[fusion]\nclimb_offset = 0.0\n");
  describe_car(config, car);
  EXPECT_EQ(config.fusion.rear_axle_distance, 0.25);
  EXPECT_EQ(config.fusion.climb_offset, 0.0);
  EXPECT_EQ(config.fusion.climb_offset_sigma, 0.0087);
  EXPECT_EQ(config.lidar.elevation_correction, 0.0036);
}

TEST(VehicleConfig, TheDescriptionOfTheVehicleReachesWhatUsesIt) {
  const VehicleConfig config = load_text(
      "[vehicle]\nside_of_road = \"left\"\n"
      "rear_axle_distance = 1.2\n[vehicle.lidar]\nbeam_elevation = 0.002\n[vehicle.antenna]\n"
      "forward = 0.5\nleft = -0.1\nup = 1.5\n[vehicle.imu]\ndelay = 0.01\n");
  EXPECT_EQ(config.fusion.rear_axle_distance, 1.2);
  EXPECT_EQ(config.lidar.elevation_correction, 0.002);
  EXPECT_EQ(config.fusion.gnss_lever_forward, 0.5);
  EXPECT_EQ(config.fusion.gnss_lever_left, -0.1);
  EXPECT_EQ(config.fusion.gnss_lever_up, 1.5);
  EXPECT_EQ(config.replay.imu_delay, 0.01);
  EXPECT_EQ(config.map.side_of_road, RoadSide::left);
  EXPECT_EQ(load_text("[map]\nside_of_road = \"right\"\n[vehicle]\nside_of_road = \"left\"\n")
                .map.side_of_road,
            RoadSide::right)
      << "its own key holds";
}

TEST(VehicleConfig, AVehiclesFileHoldsWhereTheConfigurationIsSilent) {
  const maploop::testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "cars");
  std::ofstream(folder.path() / "cars/van.toml")
      << "[vehicle]\nwheel_radius = 0.4\ntrack = 1.7\n[vehicle.camera]\ncalibration = \"c.toml\"\n";
  const auto file = folder.path() / "test.toml";
  std::ofstream(file)
      << "[vehicle]\nfile = \"cars/van.toml\"\ntrack = 1.8\n[map]\nmode = \"tight\"\n";
  const VehicleConfig config = load_vehicle_config(file);
  EXPECT_EQ(config.vehicle.car.wheel_radius, 0.4);
  EXPECT_EQ(config.vehicle.car.track, 1.8);
  EXPECT_EQ(config.vehicle.camera.calibration, (folder.path() / "cars/c.toml").string());
  EXPECT_TRUE(config.given.contains("vehicle.wheel_radius"));
  std::ofstream(folder.path() / "cars/van.toml") << "[map]\nmode = \"tight\"\n";
  EXPECT_THAT(error_of<runtime::ConfigError>([&] { load_vehicle_config(file); }),
              HasSubstr("van.toml:1:2: map: unknown key"));
}

TEST(VehicleConfig, APoseIsTheRecordingsOrTheFilesButForRounding) {
  VehicleCalibration recorded;
  recorded.T_body_velo.linear() =
      Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  recorded.T_body_velo.translation() << 1.0, 0.1, 0.7;
  recorded.stereo.width = 1242;
  recorded.stereo.height = 375;
  recorded.stereo.fx = recorded.stereo.fy = 721.5377;
  recorded.stereo.baseline = 0.54;
  recorded.stereo.T_body_cam = recorded.T_body_velo * camera_pose({}, {});
  const VehicleConfig same = load_text(to_toml(description_of(recorded)));
  EXPECT_EQ(described(same, recorded).T_body_velo.matrix(), recorded.T_body_velo.matrix());
  EXPECT_EQ(described(same, recorded).stereo.T_body_cam.matrix(),
            recorded.stereo.T_body_cam.matrix());
  EXPECT_TRUE(described(same, {}).T_body_velo.isApprox(recorded.T_body_velo, 1e-12));
  EXPECT_EQ(described(same, {}).stereo.fx, 721.5377);
  const VehicleCalibration higher = described(load_text("[vehicle.lidar]\nup = 0.8\n"), recorded);
  EXPECT_EQ(higher.T_body_velo.translation(), Eigen::Vector3d(1.0, 0.1, 0.8));
  EXPECT_TRUE(higher.T_body_velo.linear().isApprox(recorded.T_body_velo.linear(), 1e-12));
  VehicleConfig config = load_text("[vehicle.lidar]\nup = 0.8\n");
  describe_car(config, recorded);
  EXPECT_EQ(config.vehicle.lidar.position.forward_sigma, 0.02) << "of a calibration";
  EXPECT_EQ(config.vehicle.lidar.position.up_sigma, 1.0) << "of a value without one";
}

TEST(VehicleConfig, WhatIsWrittenIsReadBack) {
  VehicleConfig config;
  config.lcm_url = "udpm://239.255.76.67:7667?ttl=1";
  config.fusion.gyro_noise = 1.0 / 3.0;
  config.stereo.bucket_size = 64;
  config.gnss.seed = 77;
  config.ppp.filter.systems = "GE";
  config.ppp.filter.motion = ppp::Motion::fixed;
  config.memory.lock_memory = false;
  config.scheduling.camera = runtime::Scheduling{};
  config.scheduling.stereo.policy = runtime::SchedulingPolicy::rr;
  config.scheduling.stereo.cpus = {0, 2};
  config.scheduling.fusion = {};
  config.scheduling.fusion.policy = runtime::SchedulingPolicy::deadline;
  config.scheduling.fusion.runtime = std::chrono::microseconds(1500);
  config.scheduling.fusion.deadline = milliseconds(2);
  config.scheduling.fusion.period = milliseconds(10);
  config.scheduling.health = {};
  config.scheduling.health.policy = runtime::SchedulingPolicy::other;
  config.scheduling.health.nice = -3;
  config.scheduling.health.timer_slack = std::chrono::microseconds(50);
  EXPECT_EQ(to_toml(load_text(to_toml(config))), to_toml(config));
  EXPECT_NE(to_toml(config), to_toml(VehicleConfig{}));
}

TEST(VehicleConfig, KeysThatAreAbsentKeepTheirDefaults) {
  const VehicleConfig config = load_text("[stereo]\nbucket_size = 40\n");
  VehicleConfig expected;
  expected.stereo.bucket_size = 40;
  EXPECT_EQ(to_toml(config), to_toml(expected));
}

TEST(VehicleConfig, AThreadsTableChangesOnlyWhatItNames) {
  const VehicleConfig config = load_text("[scheduling.fusion]\npriority = 55\ncpus = [1]\n");
  VehicleConfig expected;
  expected.scheduling.fusion.priority = 55;
  expected.scheduling.fusion.cpus = {1};
  EXPECT_EQ(to_toml(config), to_toml(expected));
  EXPECT_EQ(load_text("[scheduling]\nfusion = { policy = \"other\" }\n").scheduling.fusion.priority,
            0)
      << "the default's priority is not left over";
}

TEST(VehicleConfig, WhatDoesNotGoWithThePolicyIsAnError) {
  for (const auto& [text, said] : std::initializer_list<std::pair<const char*, const char*>>{
           {"policy = \"other\"\npriority = 5",
            "fusion.priority: can only be used with policy \"fifo\" and \"rr\""},
           {"nice = 5", "fusion.nice: can only be used with policy \"other\", not with \"fifo\""},
           {"priority = 0", "fusion.priority: is 0; allowed is 1 to 99"},
           {"period_ms = 5", "fusion.period_ms: can only be used with policy \"deadline\""},
           {"policy = \"deadline\"\nruntime_ms = 3\ndeadline_ms = 2\nperiod_ms = 10",
            "runtime_ms <= deadline_ms <= period_ms"},
           {"policy = \"deadline\"\nruntime_ms = 1\ndeadline_ms = 2\nperiod_ms = 10\ncpus = [0]",
            "fusion.cpus: must be empty"},
           {"policy = \"fife\"", "did you mean \"fifo\""},
           {"prioritty = 5", "did you mean"}}) {
    EXPECT_THAT(error_of<runtime::ConfigError>([&text = text] {
                  load_text("[scheduling.fusion]\n" + std::string(text) + '\n');
                }),
                HasSubstr(said));
  }
  EXPECT_THROW(load_text("[scheduling.health]\npolicy = \"rr\"\n"), runtime::ConfigError)
      << "no priority to fall back on";
}

TEST(VehicleConfig, ProductsAreBesideTheConfiguration) {
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / "test.toml";
  std::ofstream(file) << "[ppp]\nproducts = [\"a.SP3\", \"/data/models\"]\n";
  const VehicleConfig config = load_vehicle_config(file);
  EXPECT_EQ(config.ppp.products,
            (std::vector<std::string>{(folder.path() / "a.SP3").string(), "/data/models"}));
  EXPECT_EQ(to_toml(load_text(to_toml(config))), to_toml(config));
  EXPECT_THROW(load_text("[ppp]\nproducts = [3]\n"), runtime::ConfigError);
  EXPECT_THROW(load_text("[ppp]\nproducts = \"a.SP3\"\n"), runtime::ConfigError);
  EXPECT_THROW(load_text("[ppp]\nintegrity_risk = 1.0\n"), runtime::ConfigError);
  EXPECT_THROW(load_text("[ppp]\nlatency = -1.0\n"), runtime::ConfigError);
}

TEST(VehicleConfig, AValueThatCannotWorkNamesFileAndKey) {
  for (const auto& [text, said] : std::initializer_list<std::pair<const char*, const char*>>{
           {"[fusion]\ngyro_noise = -1.0\n",
            "test.toml:2:14: fusion.gyro_noise: is -1; allowed is 1e-09 to 1 rad/sqrt(s)"},
           {"[fusion]\nmax_gap = 0.5\n",
            "test.toml:2:11: fusion.max_gap: must be at least confirm_gap"},
           {"[stereo]\nwindow = 14\n", "test.toml:2:10: stereo.window: must be odd"},
           {"[lidar]\nmap_voxel = 0.0\n",
            "test.toml:2:13: lidar.map_voxel: is 0; allowed is 0.1 to 10 m"},
           {"[lidar]\nkernel = 0\n",
            "test.toml:2:10: lidar.kernel: is 0; allowed is above 0, at most 1000000"},
           {"[mapmatch]\nmemory = 0.0\n",
            "test.toml:2:10: mapmatch.memory: is 0; allowed is 0.01 to 1000000 s"},
           {"[mapmatch]\nbirth = -1.0\n",
            "test.toml:2:9: mapmatch.birth: is -1; allowed is 0 to 1000000000"},
           {"[mapmatch]\nsure = 1.5\n", "test.toml:2:8: mapmatch.sure: is 1.5; allowed is 0 to 1"},
           {"[mapmatch]\ngate = nan\n", "test.toml:2:8: mapmatch.gate: is nan"},
           {"[feedback]\nchord = 8.0\nwindow = 100\n",
            "test.toml:3:10: feedback.window: is 100; allowed is 1 to 64 feedbacks"},
           {"[feedback]\nspacing = -5.0\n",
            "test.toml:2:11: feedback.spacing: is -5; allowed is 0 to 10000 m"},
           {"[guard]\nlifetime = 0.0\n",
            "test.toml:2:12: guard.lifetime: is 0; allowed is 0.1 to 3600 s"},
           {"[ppp]\nelevation_mask = 91.0\n",
            "test.toml:2:18: ppp.elevation_mask: is 91; allowed is 0 to 90 deg"},
           {"[ppp]\ncode_sigma = 0.0\n",
            "test.toml:2:14: ppp.code_sigma: is 0; allowed is 0.000001 to 10000 m"},
           {"[ppp]\nlongest_gap = -1\n",
            "test.toml:2:15: ppp.longest_gap: is -1; allowed is 0 to 1000000 epochs"},
           {"[ppp]\nsystems = \"GX\"\n",
            "test.toml:2:11: ppp.systems: is \"GX\"; 'X' is not one of"},
           {"[ppp]\nsystems = \"\"\n", "test.toml:2:11: ppp.systems: is empty"},
           {"[ppp]\nintegrity_risk = 1.0\n", "test.toml:2:18: ppp.integrity_risk: is 1; allowed"},
           {"[preview]\nrate = 50.0\n", "test.toml:2:8: preview.rate: is 50; allowed is 0 to 5 Hz"},
           {"[preview]\nwidth = 10\n",
            "test.toml:2:9: preview.width: is 10; allowed is 64 to 1280 px"},
           {"[map]\nmode = \"losse\"\n", "test.toml:2:8: map.mode: is \"losse\"; did you mean"},
           {"[vehicle.imu]\ndelay = -0.1\n", "test.toml:2:9: vehicle.imu.delay: is -0.1; allowed"},
           {"[vehicle.camera]\nfx = 700\n", "vehicle.camera.width: must be given together with"},
           {"[vehicle.lidar]\nmodel = \"VLP-17\"\n",
            "test.toml:2:9: vehicle.lidar.model: is \"VLP-17\""},
           {"[vehicle.lidar]\nforwards = 1.0\n",
            "test.toml:2:1: vehicle.lidar.forwards: unknown key"},
           {"[live]\nvelodyne_model = \"VLP-16\"\n",
            "test.toml:2:1: live.velodyne_model: unknown key; its place is now "
            "vehicle.lidar.model"},
           {"[camera]\ncalibration = \"rig.toml\"\n",
            "the place of camera.calibration is now vehicle.camera.calibration"},
           {"[vehicle.lidar]\nup_sigma = 0\n", "test.toml:2:12: vehicle.lidar.up_sigma: is 0"},
           {"[vehicle]\nside_of_road = \"middle\"\n", "vehicle.side_of_road: is \"middle\""},
           {"[vehicle]\nfile = \"nowhere.toml\"\n", "nowhere.toml"},
           {"[gnss]\nrate = 0\n", "test.toml:2:8: gnss.rate: is 0; allowed is 0.001 to 1000 Hz"},
           {"[wheel]\nslip = 1.0\n", "test.toml:2:8: wheel.slip: is 1; allowed is 0 to 0.1"},
           {"[odometry_poses]\nspeed_sigma = 0\n", "test.toml:2:15: odometry_poses.speed_sigma"},
           {"[memory]\nheap_mb = -1\n", "test.toml:2:11: memory.heap_mb: is -1; allowed is 0 to"},
           {"[trace]\nevents_per_thread = 0\n", "test.toml:2:21: trace.events_per_thread: is 0"},
           {"[live]\ngnss_frequencies = 3\n",
            "test.toml:2:20: live.gnss_frequencies: is 3; allowed is 1 to 2 frequencies"},
           {"[live]\nimu_protocol = \"ncmo\"\n",
            "test.toml:2:16: live.imu_protocol: is \"ncmo\"; did you mean \"ncom\"?"},
           {"[imu]\nnoise = \"none\"\n", "test.toml:2:9: imu.noise: is \"none\""},
           {"odometry = \"lidar\"\n", "test.toml:1:12: odometry: is \"lidar\""},
           {"configuration = \"VO\"\n",
            "test.toml:1:17: configuration: no configuration is called 'VO'"},
           {"imu_grade = \"best\"\n", "test.toml:1:13: imu_grade: "}}) {
    EXPECT_THAT(error_of<runtime::ConfigError>([&text = text] { load_text(text); }),
                HasSubstr(said));
  }
}

TEST(VehicleConfig, AnUnknownTableIsAnError) {
  EXPECT_THAT(error_of<runtime::ConfigError>([&] { load_text("[sterio]\nbucket_size = 40\n"); }),
              AllOf(HasSubstr("sterio"), HasSubstr("test.toml:1")));
}

}  // namespace
}  // namespace maploop::vehicle
