// Messages of ROS, from a real recording in both encodings, damaged, and of other definitions.
#include "sensors/bag/ros_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sensors/bag/bag_contents.h"

namespace maploop::sensors {
namespace {

using testing::BagContents;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kitti_bag;
using testing::read_bag;
using testing::ReadMessage;

template <class T>
T first_of(const BagContents& bag, const std::string& topic) {
  T message;
  for (const ReadMessage& m : bag.messages) {
    if (m.topic != topic) continue;
    EXPECT_EQ(problem_of<T>(bag.topics.at(topic)), "");
    decode(bag.topics.at(topic), testing::as_bytes(m.data), message);
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
        decode(topic, testing::as_bytes(data.substr(0, size)), message);
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
  EXPECT_THROW(RosCursor(testing::as_bytes(parameter_list), RosEncoding::cdr),
               std::invalid_argument);
}

TEST(RosCursor, AlignsAndSwapsBigEndian) {
  const std::string message("\0\0\0\0\1\0\0\2\0\0\0\0\77\360\0\0\0\0\0\0", 20);
  RosCursor cursor(testing::as_bytes(message), RosEncoding::cdr);
  EXPECT_EQ(cursor.number<std::uint8_t>(), 1);
  EXPECT_EQ(cursor.number<std::uint16_t>(), 2);
  EXPECT_EQ(cursor.number<double>(), 1.0);
}

}  // namespace
}  // namespace maploop::sensors
