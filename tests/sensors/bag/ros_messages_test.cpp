// Messages of ROS, from a real recording in both encodings, damaged, and of other definitions.
#include "sensors/bag/ros_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "sensors/bag/camera_messages.h"
#include "sensors/bag/cloud_messages.h"
#include "tests/sensors/bag/bag_contents.h"

namespace maploop::sensors {
namespace {

using testing::BagContents;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kitti_bag;
using testing::read_bag;
using testing::ReadMessage;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <class T>
T first_of(const BagContents& bag, const std::string& topic) {
  T message;
  for (const ReadMessage& m : bag.messages) {
    if (m.topic != topic) continue;
    EXPECT_EQ(problem_of<T>(bag.topics.at(topic)), "");
    decode(bag.topics.at(topic), bytes_of(m.data), message);
    return message;
  }
  ADD_FAILURE() << "there is no message of " << topic;
  return message;
}

TEST(RosMessages, AreTheSameInBothEncodings) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const BagContents ros1 = read_bag(kitti_bag("kitti13_ros1_bz2.bag")),
                    cdr = read_bag(kitti_bag("kitti13_zstd.mcap"));
  for (const BagContents* bag : {&ros1, &cdr}) {
    const auto imu = first_of<RosImu>(*bag, "/imu/data");
    EXPECT_EQ(imu.header.frame, "imu");
    EXPECT_EQ(to_nanoseconds(imu.header.stamp), 1317042651175862102);
    EXPECT_EQ(imu.linear_acceleration.x(), -0.43999459306673);
    EXPECT_EQ(imu.angular_velocity.z(), 0.0062110895146255);
    const auto fix = first_of<RosFix>(*bag, "/gps/fix");
    EXPECT_EQ(fix.latitude, 49.013141872681);
    EXPECT_EQ(fix.covariance_type, 1);
    EXPECT_NEAR(fix.covariance(1, 1), 0.022385, 1e-9);
    EXPECT_EQ(first_of<RosTwist>(*bag, "/gps/vel").linear.x(), 11.842084178285);
    const auto info = first_of<RosCameraInfo>(*bag, "/stereo/right/camera_info");
    EXPECT_EQ(info.distortion_model, "plumb_bob");
    EXPECT_THAT(info.d, ElementsAre(0, 0, 0, 0, 0));
    EXPECT_EQ(info.p[3], -387.5744);
    const auto image = first_of<RosImage>(*bag, "/stereo/left/image_rect");
    EXPECT_EQ(image.encoding, "mono8");
    EXPECT_EQ(image.data.size(), 1242U * 375U);
    const auto cloud = first_of<RosPointCloud>(*bag, "/velodyne_points");
    EXPECT_EQ(cloud.width, 115267U);
    EXPECT_EQ(cloud.fields.at(3).name, "intensity");
    EXPECT_EQ(first_of<RosTransforms>(*bag, "/tf_static").transforms.size(), 4U);
  }
}

TEST(RosMessages, ThatAreCutOrChangedAreRefused) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const BagContents bag = read_bag(kitti_bag("kitti13_zstd.mcap"));
  const auto decode_cut = []<class T>(const Topic& topic, const std::string& data, T) {
    for (std::size_t size = 0; size < data.size(); size += 1 + data.size() / 500) {
      T message;
      try {
        decode(topic, bytes_of(data.substr(0, size)), message);
      } catch (const std::invalid_argument&) {
        continue;
      }
      // Only what follows the last value that is read may be missing: nine numbers of Imu.
      EXPECT_GT(size, data.size() - 80) << topic.name;
    }
  };
  for (const ReadMessage& m : bag.messages) {
    const Topic& topic = bag.topics.at(m.topic);
    if (topic.type == "sensor_msgs/Imu") decode_cut(topic, m.data, RosImu());
    if (topic.type == "sensor_msgs/NavSatFix") decode_cut(topic, m.data, RosFix());
    if (topic.type == "sensor_msgs/Image") decode_cut(topic, m.data, RosImage());
    if (topic.type == "sensor_msgs/PointCloud2") decode_cut(topic, m.data, RosPointCloud());
    if (topic.type == "tf2_msgs/TFMessage") decode_cut(topic, m.data, RosTransforms());
  }
}

TEST(RosMessages, OfAnotherTypeEncodingOrDefinitionAreNamed) {
  Topic topic{"/imu", "sensor_msgs/Imu", "cdr", ""};
  EXPECT_EQ(problem_of<RosImu>(topic), "");
  topic.encoding = "protobuf";
  EXPECT_THAT(problem_of<RosImu>(topic), HasSubstr("'protobuf'"));
  topic.encoding = "ros1";
  topic.definition =
      "Header header  # a comment\nuint8 KIND=3\nfloat64 rate\n====\nfloat64 other\n";
  EXPECT_THAT(problem_of<RosImu>(topic), HasSubstr("other fields: header header;float64 rate;"));
  topic.type = "my_msgs/Imu";
  EXPECT_THAT(problem_of<RosImu>(topic), HasSubstr("its type is my_msgs/Imu"));
}

TEST(RosCursor, RefusesAnotherRepresentation) {
  const std::string parameter_list("\0\3\0\0", 4);
  EXPECT_THROW(RosCursor(bytes_of(parameter_list), RosEncoding::cdr), std::invalid_argument);
}

TEST(RosCursor, AlignsAndSwapsBigEndian) {
  const std::string message("\0\0\0\0\1\0\0\2\0\0\0\0\77\360\0\0\0\0\0\0", 20);
  RosCursor cursor(bytes_of(message), RosEncoding::cdr);
  EXPECT_EQ(cursor.number<std::uint8_t>(), 1);
  EXPECT_EQ(cursor.number<std::uint16_t>(), 2);
  EXPECT_EQ(cursor.number<double>(), 1.0);
}

// A real cloud of another scanner: 64 000 points of 26 bytes with unaligned times since 1970.
TEST(CloudMessage, OfUnalignedPointsHasTimes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string file = testing::bytes_of(testing::recorded_bag("cloudini_dds_message.bin"));
  RosPointCloud message;
  decode({"/points", "sensor_msgs/PointCloud2", "cdr", ""}, bytes_of(file), message);
  EXPECT_EQ(message.width * message.height, 64'000U);
  EXPECT_EQ(message.point_step, 26U);
  TimedCloud cloud;
  read_cloud(message, cloud);
  ASSERT_GT(cloud.points.size(), 10'000U);
  ASSERT_EQ(cloud.times.size(), cloud.points.size());
  const auto [first, last] = std::ranges::minmax(cloud.times);
  EXPECT_NEAR(to_seconds(last - first), 0.05, 0.001);  // half of a turn, or a scanner of 20 Hz
  EXPECT_LT(std::abs(to_seconds(first - message.header.stamp)), 0.2);
  float first_x = 0.0F;
  std::memcpy(&first_x, message.data.data(), sizeof first_x);
  EXPECT_EQ(cloud.points.front().x, first_x);
}

// A cloud with fields x, y, z and one time of a type.
struct MadeCloud {
  std::string data;
  RosPointCloud message;

  template <class Number>
  void make(const std::vector<Number>& times, std::string_view name, std::uint8_t datatype) {
    const std::size_t step = 12 + sizeof(Number);
    data.assign(times.size() * step, '\0');
    for (std::size_t i = 0; i < times.size(); ++i) {
      const float xyz[] = {1.0F + static_cast<float>(i), 2.0F, 3.0F};
      std::memcpy(data.data() + i * step, xyz, sizeof xyz);
      std::memcpy(data.data() + i * step + sizeof xyz, &times[i], sizeof(Number));
    }
    constexpr std::uint8_t float32 = 7;
    message.header.stamp = from_nanoseconds(1'700'000'000'000'000'000);
    message.height = 1;
    message.width = static_cast<std::uint32_t>(times.size());
    message.fields = {
        {"x", 0, float32, 1}, {"y", 4, float32, 1}, {"z", 8, float32, 1}, {name, 12, datatype, 1}};
    message.point_step = static_cast<std::uint32_t>(step);
    message.row_step = static_cast<std::uint32_t>(data.size());
    message.data = bytes_of(data);
  }
};

TEST(CloudMessage, FindsTheUnitOfTimes) {
  const auto expect_tenth = [](const auto& times, std::uint8_t datatype) {
    MadeCloud made;
    made.make(times, "t", datatype);
    TimedCloud cloud;
    read_cloud(made.message, cloud);
    ASSERT_EQ(cloud.times.size(), 2U);
    EXPECT_NEAR(to_seconds(cloud.times[0] - made.message.header.stamp), 0.0, 1e-6);
    EXPECT_NEAR(to_seconds(cloud.times[1] - made.message.header.stamp), 0.1, 1e-6);
  };
  expect_tenth(std::vector<std::uint32_t>{0, 100'000'000}, 6);             // ns
  expect_tenth(std::vector<float>{0.0F, 0.1F}, 7);                         // s
  expect_tenth(std::vector<float>{0.0F, 100.0F}, 7);                       // ms
  expect_tenth(std::vector<std::int32_t>{0, 100'000}, 5);                  // us
  expect_tenth(std::vector<double>{1'700'000'000.0, 1'700'000'000.1}, 8);  // s since 1970
  expect_tenth(std::vector<double>{1.7e18, 1.7e18 + 1e8}, 8);              // ns since 1970
}

TEST(CloudMessage, WithoutTimesOrWithEqualOnesHasNone) {
  MadeCloud made;
  made.make(std::vector<float>{0.0F, 0.0F}, "t", 7);
  TimedCloud cloud;
  read_cloud(made.message, cloud);
  EXPECT_TRUE(cloud.times.empty());
}

TEST(CloudMessage, RefusesWhatDoesNotFit) {
  const auto refused = [](const auto& change) {
    MadeCloud made;
    made.make(std::vector<float>{0.0F, 0.1F}, "t", 7);
    change(made.message);
    TimedCloud cloud;
    try {
      read_cloud(made.message, cloud);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refused([](auto& m) { m.width = 3; }), HasSubstr("are not 1 x 3 points"));
  EXPECT_THAT(refused([](auto& m) { m.point_step = 0; }), HasSubstr("of 0 bytes"));
  EXPECT_THAT(refused([](auto& m) { m.fields[2].offset = 13; }), HasSubstr("field z is beyond"));
  EXPECT_THAT(refused([](auto& m) { m.fields[1].name = "w"; }), HasSubstr("no field y"));
  EXPECT_THAT(refused([](auto& m) { m.height = m.width = 0; }), HasSubstr("no finite point"));
  EXPECT_THAT(refused([](auto& m) {
                m.height = 2;
                m.width = 1;
                m.row_step = 0xffffffff;
              }),
              HasSubstr("rows of 4294967295 bytes"));
}

// A scanner that begins to the left, and takes 0.1 s a turn.
TEST(CloudTurns, GoFromRearToRearWhereverTheCloudsBegin) {
  CloudTurns turns(std::chrono::milliseconds(250));
  const Time begin = from_nanoseconds(1'700'000'000'000'000'000);
  std::vector<LidarScan> scans;
  for (int cloud_number = 0; cloud_number < 3; ++cloud_number) {
    TimedCloud cloud;
    for (int i = 3599; i >= 0; --i) {  // in an order that is not that of time
      const double share = i / 3600.0;
      const double angle = std::numbers::pi / 2.0 - 2.0 * std::numbers::pi * share;
      cloud.points.push_back({static_cast<float>(10.0 * std::cos(angle)),
                              static_cast<float>(10.0 * std::sin(angle)), 0.0F, 0.0F});
      cloud.times.push_back(begin + from_seconds(0.1 * (cloud_number + share)));
    }
    turns.add(cloud);
    for (LidarScan scan; turns.next(scan);) scans.push_back(scan);
  }
  ASSERT_EQ(scans.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const double turn = static_cast<double>(i);
    EXPECT_NEAR(to_seconds(scans[i].start - begin), 0.1 * turn + 0.075, 1e-4);
    EXPECT_NEAR(to_seconds(scans[i].stamp - begin), 0.1 * turn + 0.125, 1e-4);
    EXPECT_NEAR(to_seconds(scans[i].end - begin), 0.1 * turn + 0.175, 1e-4);
    EXPECT_EQ(scans[i].points.size(), 3600U);
  }
}

RosImage made_image(std::string_view encoding, std::uint32_t step, const std::string& data) {
  RosImage image;
  image.encoding = encoding;
  image.width = image.height = 2;
  image.step = step;
  image.data = bytes_of(data);
  return image;
}

TEST(CameraMessage, BecomesGreyFromEachEncoding) {
  GreyImage grey;
  const std::string padded("\1\2..\3\4..", 8);
  to_grey(made_image("mono8", 4, padded), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(1, 2, 3, 4));
  const std::string wide("\0\1\0\2\0\3\0\4", 8);
  to_grey(made_image("mono16", 4, wide), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(1, 2, 3, 4));
  const std::string colours("\377\0\0\0\377\0\0\0\377\144\144\144", 12);
  to_grey(made_image("rgb8", 6, colours), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(76, 150, 29, 100));
  to_grey(made_image("bgr8", 6, colours), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(29, 150, 76, 100));
  // Red 40, green 80, blue 120: a quarter, a half and a quarter.
  const std::string bayer("\50\120\120\170", 4);
  to_grey(made_image("bayer_rggb8", 2, bayer), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(80, 80, 80, 80));
}

TEST(CameraMessage, IsRefusedWithTheReason) {
  const auto refused = [](const RosImage& image) {
    GreyImage grey;
    try {
      to_grey(image, grey);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string four(4, '\1');
  EXPECT_THAT(refused(made_image("yuv422", 4, four)), HasSubstr("'yuv422' is not supported"));
  EXPECT_THAT(refused(made_image("mono8", 1, four)), HasSubstr("too few"));
  EXPECT_THAT(refused(made_image("rgb8", 6, four)), HasSubstr("too few"));
  RosImage huge = made_image("mono8", 0xffffffff, four);
  huge.width = huge.height = 0xffffffff;
  EXPECT_THAT(refused(huge), HasSubstr("out of range"));
}

RosCameraInfo info_of(const CameraModel& camera, const Eigen::Matrix3d& R, double tx) {
  RosCameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  const Distortion& d = camera.distortion;
  info.d = {d.k1, d.k2, d.p1, d.p2, d.k3};
  const double k[9] = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  const double p[12] = {500, 0, 320, tx, 0, 500, 240, 0, 0, 0, 1, 0};
  std::copy_n(k, 9, info.k);
  std::copy_n(p, 12, info.p);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(info.r) = R;
  return info;
}

TEST(StereoMessages, GiveTheRigOfRawImages) {
  const CameraModel camera{510, 512, 318, 243, {-0.3, 0.1, 0.001, -0.002, 0.0}};
  const Eigen::Matrix3d R_left = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()).matrix();
  const Eigen::Matrix3d R_right = Eigen::AngleAxisd(-0.02, Eigen::Vector3d::UnitX()).matrix();
  const RosStereo stereo =
      stereo_of(info_of(camera, R_left, 0), info_of(camera, R_right, -60), false);
  ASSERT_TRUE(stereo.raw);
  EXPECT_NEAR(stereo.rectified.baseline, 0.12, 1e-12);
  // The right camera is where the rectified axes and the baseline put it.
  const Eigen::Vector3d right_centre = stereo.raw->T_right_left.inverse().translation();
  EXPECT_TRUE((R_left * right_centre).isApprox(Eigen::Vector3d(0.12, 0, 0), 1e-12));
  EXPECT_FALSE(stereo_of(info_of(camera, R_left, 0), info_of(camera, R_right, -60), true).raw);
}

TEST(StereoMessages, AreRefusedWithTheReason) {
  const CameraModel camera{510, 512, 318, 243, {-0.3, 0.1, 0.001, -0.002, 0.0}};
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const auto refused = [](const RosCameraInfo& left, const RosCameraInfo& right) {
    try {
      stereo_of(left, right, false);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const RosCameraInfo left = info_of(camera, I, 0), right = info_of(camera, I, -60);
  EXPECT_EQ(refused(left, right), "");
  EXPECT_THAT(refused(left, left), HasSubstr("not calibrated as a pair"));
  EXPECT_THAT(refused(RosCameraInfo(), right), HasSubstr("not calibrated"));
  RosCameraInfo fisheye = right;
  fisheye.distortion_model = "equidistant";
  EXPECT_THAT(refused(left, fisheye), HasSubstr("'equidistant'"));
  RosCameraInfo small = right;
  small.width = 320;
  EXPECT_THAT(refused(left, small), HasSubstr("different sizes"));
}

}  // namespace
}  // namespace maploop::sensors
