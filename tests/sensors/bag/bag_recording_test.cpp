// Bags as recorded drives: the same bits as the files that they were made from, and what a
// recording without them is told.
#include "sensors/bag/bag_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/bag/body_frame.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/velodyne/capture_source.h"
#include "sensors/velodyne/data_packet.h"
#include "tests/sensors/bag/bag_contents.h"
#include "tests/sensors/bag/made_mcap.h"

namespace maploop::sensors {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kitti_bag;
using testing::recorded_bag;

BagRecording open(const std::filesystem::path& path, const BagParameters& parameters = {}) {
  return {path, summarize(path), parameters, {}, {}};
}

template <class T>
std::vector<T> all_of(std::unique_ptr<Source<T>> source, std::size_t most = 1'000'000) {
  std::vector<T> samples;
  for (T sample; samples.size() < most && source->next(sample);) samples.push_back(sample);
  return samples;
}

class BagOfDrive0013 : public ::testing::TestWithParam<const char*> {};

TEST_P(BagOfDrive0013, HasTheBitsOfItsFiles) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MAPLOOP_REQUIRE_DRIVE();
  const BagRecording bag = open(kitti_bag(GetParam()));
  KittiDriveParameters parameters;
  parameters.imu_delay = 0.0;
  const KittiDrive drive(testing::drive_0013(), parameters);

  const auto images = all_of(bag.camera(Time::min())), same_images = all_of(drive.camera(), 3);
  ASSERT_EQ(images.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(images[i].stamp, same_images[i].stamp);
    EXPECT_EQ(images[i].available, same_images[i].available);
    EXPECT_EQ(images[i].left.pixels, same_images[i].left.pixels);
    EXPECT_EQ(images[i].right.pixels, same_images[i].right.pixels);
  }
  const auto scans = all_of(bag.lidar(Time::min())), same_scans = all_of(drive.velodyne(), 3);
  ASSERT_EQ(scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scans[i].stamp, same_scans[i].stamp);
    EXPECT_NEAR(to_seconds(scans[i].start - same_scans[i].start), 0.0, 0.002);
    ASSERT_EQ(scans[i].points.size(), same_scans[i].points.size());
    EXPECT_EQ(0, std::memcmp(scans[i].points.data(), same_scans[i].points.data(),
                             scans[i].points.size() * sizeof(LidarPoint)));
  }
  const auto inertial = all_of(bag.imu(nullptr, {}, 0.0)), same_inertial = all_of(drive.imu(), 4);
  ASSERT_EQ(inertial.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(inertial[i].stamp, same_inertial[i].stamp);
    EXPECT_EQ(inertial[i].specific_force_forward, same_inertial[i].specific_force_forward);
    EXPECT_EQ(inertial[i].specific_force_left, same_inertial[i].specific_force_left);
    EXPECT_EQ(inertial[i].yaw_rate, same_inertial[i].yaw_rate);
  }
  const VehicleCalibration &ours = bag.calibration(), &theirs = drive.calibration();
  EXPECT_EQ(ours.stereo.fx, theirs.stereo.fx);
  EXPECT_EQ(ours.stereo.cy, theirs.stereo.cy);
  EXPECT_NEAR(ours.stereo.baseline, theirs.stereo.baseline, 1e-9);
  EXPECT_TRUE(ours.stereo.T_body_cam.isApprox(theirs.stereo.T_body_cam, 1e-5));
  EXPECT_TRUE(ours.T_body_velo.isApprox(theirs.T_body_velo, 1e-5));
  EXPECT_EQ(bag.frame_count(), 3U);
  EXPECT_EQ(bag.first_stamp(), drive.image_stamps()[0]);
  EXPECT_EQ(bag.last_stamp(), drive.image_stamps()[2]);
  EXPECT_THAT(bag.notes(), Contains(HasSubstr("/gps/vel")));
}

INSTANTIATE_TEST_SUITE_P(Forms, BagOfDrive0013,
                         ::testing::Values("kitti13_zstd.mcap", "kitti13_ros1_bz2.bag",
                                           "kitti13_ros2_zstd_message"));

TEST(BagRecording, TakesTheGivenTopics) {
  MAPLOOP_REQUIRE_REAL_DATA();
  BagParameters parameters;
  parameters.topics = {"lidar=none", "gnss.velocity=/gps/vel", "camera.left=none",
                       "camera.right=none"};
  const BagRecording bag = open(kitti_bag("kitti13_zstd.mcap"), parameters);
  EXPECT_FALSE(bag.has(BagSensor::lidar));
  EXPECT_FALSE(bag.has(BagSensor::camera_left));
  const auto fixes = all_of(bag.gnss());
  ASSERT_EQ(fixes.size(), 4U);
  // The message of the velocity comes after that of the fix whose stamp it has.
  EXPECT_EQ(fixes[0].velocity_enu.x(), 11.842084178285);
  for (const GnssFix& fix : fixes) EXPECT_EQ(fix.velocity_stamp, fix.stamp);
  EXPECT_EQ(bag.frame_count(), 4U);
}

TEST(BagRecording, SaysWhatIsWrongWithATopic) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto refused = [](const char* topic) {
    BagParameters parameters;
    parameters.topics = {topic};
    try {
      open(kitti_bag("kitti13_zstd.mcap"), parameters);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refused("lidar"), HasSubstr("'lidar' is not SENSOR=TOPIC"));
  EXPECT_THAT(refused("radar=/x"), HasSubstr("one of the sensors camera.left"));
  EXPECT_THAT(refused("lidar=/x"), HasSubstr("has no topic '/x' for lidar; it has"));
  EXPECT_THAT(refused("lidar=/imu/data"), HasSubstr("cannot be lidar: its type is"));
  EXPECT_THAT(refused("camera.left=/stereo/left/image_rect"), HasSubstr("needs both"));
}

TEST(BagRecording, OfOtherThingsIsRefusedWithWhatItHas) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const char* name :
       {"example.bag", "example-bz2.bag", "example-lz4.bag", "evo_tf_example.db3",
        "lb_example_logs.mcap", "lb_custom-camera-model.mcap"}) {
    SCOPED_TRACE(name);
    try {
      open(recorded_bag(name));
      ADD_FAILURE() << "was opened";
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr("has no messages of a sensor that can be used: it has /"));
    }
  }
  for (const char* name : {"imu_phidgets_upside_down.bag", "imu_sparkfun_razor.bag"}) {
    SCOPED_TRACE(name);
    try {
      open(recorded_bag(name));
      ADD_FAILURE() << "was opened";
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr("only an inertial unit"));
    }
  }
}

TEST(BagRecording, DerivesTheVelocityOfFixes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto fixes = all_of(open(recorded_bag("rviz_satellite_sample.bag")).gnss());
  ASSERT_GT(fixes.size(), 100U);
  std::size_t known = 0;
  for (const GnssFix& fix : fixes) {
    const bool has = fix.velocity_covariance(0, 0) < 100.0;
    known += has ? 1 : 0;
    if (!has) {
      EXPECT_EQ(fix.velocity_enu.norm(), 0.0);
    }
  }
  const double seconds = to_seconds(fixes.back().stamp - fixes.front().stamp);
  EXPECT_NEAR(static_cast<double>(known), seconds - 2.0, 2.0);
}

// A capture of a real scanner, as messages of five packets each.
TEST(BagRecording, OfPacketsHasTheScansOfTheCapture) {
  MAPLOOP_REQUIRE_REAL_DATA();
  using namespace made_mcap;
  const auto capture_file = testing::real_data() / "velodyne/vlp16_moving_car.pcap";
  const auto number = [](std::int64_t n) { return field(static_cast<std::uint32_t>(n)); };
  const auto stamp = [&](std::int64_t ns) {
    return number(ns / 1'000'000'000) + number(ns % 1'000'000'000);
  };
  std::string records = schema(1, "velodyne_msgs/msg/VelodyneScan", "ros1msg",
                               "Header header\nVelodynePacket[] packets\n") +
                        channel(1, "/velodyne_packets", "ros1");
  std::vector<std::string> packets;
  std::int64_t last = 0;
  const auto flush = [&] {
    std::string data = number(0) + stamp(last) + text("velodyne") +
                       number(static_cast<std::int64_t>(packets.size()));
    for (const std::string& packet : packets) data += packet;
    records += message(1, static_cast<std::uint64_t>(last), data);
    packets.clear();
  };
  CaptureReader reader(capture_file);
  for (CapturedPacket packet; reader.next(packet);) {
    if (packet.payload.size() != velodyne_data_size) continue;
    last = to_nanoseconds(packet.time);
    packets.push_back(stamp(last) + std::string(packet.payload.begin(), packet.payload.end()));
    if (packets.size() == 5) flush();
  }
  flush();
  const testing::TemporaryFolder folder;
  const auto made = testing::write_bytes(folder.path() / "packets.mcap", file(records));
  const auto scans = all_of(open(made).lidar(Time::min()));
  VelodyneCapture capture(capture_file, {});
  std::size_t same = 0;
  for (LidarScan scan; capture.next(scan); ++same) {
    ASSERT_LT(same, scans.size());
    EXPECT_EQ(scans[same].stamp, scan.stamp);
    EXPECT_EQ(scans[same].end, scan.end);
    ASSERT_EQ(scans[same].points.size(), scan.points.size());
    EXPECT_EQ(0, std::memcmp(scans[same].points.data(), scan.points.data(),
                             scan.points.size() * sizeof(LidarPoint)));
  }
  EXPECT_EQ(same, scans.size());
  EXPECT_GE(same, 2U);
}

Topic image(const char* name) {
  return {name, "sensor_msgs/Image", "cdr", ""};
}

BagSummary summary_of(std::initializer_list<Topic> topics) {
  BagSummary summary;
  for (const Topic& topic : topics) summary.topics.push_back({topic, 1, {}, {}});
  return summary;
}

TEST(TopicChoice, PairsCamerasByName) {
  const Topic info{"/cam0/camera_info", "sensor_msgs/CameraInfo", "cdr", ""};
  const TopicChoice choice =
      choose_topics("a.bag",
                    summary_of({image("/cam0/image_raw"), info, image("/cam1/image_raw"),
                                image("/cam2/image_raw")}),
                    {});
  ASSERT_NE(choice.find(BagSensor::camera_left), nullptr);
  EXPECT_EQ(choice.find(BagSensor::camera_left)->name, "/cam0/image_raw");
  EXPECT_EQ(choice.find(BagSensor::camera_right)->name, "/cam1/image_raw");
  EXPECT_EQ(choice.find(BagSensor::camera_left_info)->name, "/cam0/camera_info");
  EXPECT_EQ(choice.find(BagSensor::camera_right_info), nullptr);
  EXPECT_THAT(choice.notes, Contains("The images of /cam2/image_raw are not used."));
}

TEST(TopicChoice, PrefersRectifiedAndGreyImages) {
  const TopicChoice choice =
      choose_topics("a.bag",
                    summary_of({image("/left/image_raw"), image("/left/image_rect"),
                                image("/left/image_rect_color"), image("/right/image_raw"),
                                image("/right/image_rect"), image("/right/image_rect_color")}),
                    {});
  EXPECT_EQ(choice.find(BagSensor::camera_left)->name, "/left/image_rect");
  EXPECT_EQ(choice.find(BagSensor::camera_right)->name, "/right/image_rect");
}

TEST(TopicChoice, AsksWhereSeveralTopicsCanBeASensor) {
  const Topic a{"/imu/data", "sensor_msgs/Imu", "ros1", ""}, b{"/imu/raw", a.type, "ros1", ""};
  try {
    choose_topics("a.bag", summary_of({a, b}), {});
    ADD_FAILURE() << "was not asked for";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(),
                HasSubstr("'a.bag': several topics can be the sensor imu: /imu/data, /imu/raw; "
                          "choose one with --topic imu=/imu/data"));
  }
  EXPECT_EQ(choose_topics("a.bag", summary_of({a, b}), {"imu=/imu/raw"}).find(BagSensor::imu)->name,
            "/imu/raw");
  EXPECT_EQ(choose_topics("a.bag", summary_of({a, b}), {"imu=none"}).find(BagSensor::imu), nullptr);
}

Eigen::Isometry3d shifted(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(FrameTree, JoinsFramesBothWaysAndSurvivesCircles) {
  FrameTree tree;
  tree.add("/a", "b", shifted(1, 0, 0));
  tree.add("b", "c", shifted(0, 2, 0));
  tree.add("c", "a", shifted(-1, -2, 0));
  tree.add("b", "b", shifted(9, 9, 9));
  EXPECT_TRUE(tree.find("a", "c")->translation().isApprox(Eigen::Vector3d(1, 2, 0)));
  EXPECT_TRUE(tree.find("c", "b")->translation().isApprox(Eigen::Vector3d(0, -2, 0)));
  EXPECT_FALSE(tree.find("a", "elsewhere"));
  EXPECT_TRUE(tree.find("elsewhere", "elsewhere"));
}

// A LiDAR that looks left, and an inertial unit on its back below it.
TEST(BodyFrame, HasTheAxesOfTheBaseAndTheOriginOfTheInertialUnit) {
  FrameTree tree;
  Eigen::Isometry3d lidar = shifted(1, 0, 2), imu = shifted(0.5, 0, 0.3);
  lidar.rotate(Eigen::AngleAxisd(radians(90), Eigen::Vector3d::UnitZ()));
  imu.rotate(Eigen::AngleAxisd(radians(180), Eigen::Vector3d::UnitX()));
  tree.add("base_link", "lidar", lidar);
  tree.add("base_link", "imu", imu);
  const BodyFrame body = choose_body_frame(tree, {"", "lidar", "imu", {0, 0, -9.8}});
  EXPECT_TRUE(body.T_body_lidar.translation().isApprox(Eigen::Vector3d(0.5, 0, 1.7)));
  EXPECT_TRUE(body.T_body_lidar.linear().isApprox(lidar.linear()));
  ASSERT_TRUE(body.R_body_imu);
  EXPECT_TRUE(body.R_body_imu->isApprox(imu.linear()));
  EXPECT_THAT(body.notes, IsEmpty());
}

TEST(BodyFrame, DoesNotBelieveATransformAgainstGravity) {
  FrameTree tree;
  tree.add("base_link", "imu", shifted(0, 0, 0));
  const BodyFrame body = choose_body_frame(tree, {"", "", "imu", {0, 0, -9.8}});
  EXPECT_FALSE(body.R_body_imu);
  EXPECT_THAT(body.notes, Contains(HasSubstr("does not point up")));
}

TEST(BodyFrame, WithoutABaseIsThatOfAnInertialUnitThatLooksAhead) {
  FrameTree tree;
  Eigen::Isometry3d camera = shifted(1, 0.2, 1);
  camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // x right, y down, z forward
  tree.add("imu", "camera", camera);
  const BodyFrame body = choose_body_frame(tree, {"camera", "", "imu", {0.1, 0, 9.8}});
  EXPECT_TRUE(body.T_body_camera.isApprox(camera));
  ASSERT_TRUE(body.R_body_imu);
  EXPECT_TRUE(body.R_body_imu->isIdentity());
}

TEST(BodyFrame, WithoutTransformsIsThatOfTheLidar) {
  const BodyFrame body = choose_body_frame({}, {"camera", "lidar", "imu", {0, 0, 9.8}});
  EXPECT_TRUE(body.T_body_lidar.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(body.R_body_imu);
  EXPECT_THAT(body.notes, Contains(HasSubstr("of the camera to 'lidar'")));
  EXPECT_THAT(body.notes, Contains(HasSubstr("of the inertial unit to 'lidar'")));
}

}  // namespace
}  // namespace maploop::sensors
