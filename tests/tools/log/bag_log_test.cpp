// Tests `log convert` to a bag of ROS 1 and back: the file is read by our own reader as a log and
// as a recording of others, by npm's, and by ROS's own.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "msgs/frames.h"
#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/conversions.h"
#include "sensors/bag/message_reader.h"
#include "sensors/bag/ros_messages.h"
#include "sensors/replay/log_events.h"
#include "sensors/replay/log_recording.h"
#include "tests/support/process.h"
#include "tests/tools/log/replayed_log.h"
#include "tests/tools/log/small_log.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;
using sensors::MessageReader;

// The log has one message of every sensor, also an image and a cloud, one of the map matcher, and
// one of an unknown type.
class BagLogTest : public LogToolsTest, public ::testing::WithParamInterface<const char*> {
 protected:
  BagLogTest() {
    const path sensors_log = maploop::testing::source("tests/fuzz/corpus/recording/sensors.lcmlog");
    std::ostringstream said;
    const path match_log = folder_.path() / "match.lcmlog";
    record(match_log, {{"MAP_MATCH", test_start, map_match_bytes()}});
    const std::vector<path> logs{log_, sensors_log, match_log};
    merge(logs, types_, all_, said);
  }
  std::string converted(const std::string& compression = "lz4") {
    std::ostringstream said;
    convert(all_, types_, bag_, compression, said);
    return said.str();
  }
  // Makes a recording of others of the bag.
  void forget_the_profile() {
    auto bytes = read_bytes(bag_);
    const std::string_view profile = "profile=maploop";
    const auto at = std::search(bytes.begin(), bytes.end(), profile.begin(), profile.end());
    ASSERT_NE(at, bytes.end());
    *at = 'P';
    write_bytes(bag_, bytes);
  }

  const path all_ = folder_.path() / "all.lcmlog", bag_ = folder_.path() / "out.bag";
};

TEST_P(BagLogTest, GivesTheSameLogBack) {
  EXPECT_TRUE(contains(converted(GetParam()), "of unknown types"));
  EXPECT_TRUE(sensors::is_own_recording(bag_));
  std::ostringstream said;
  const path back = folder_.path() / "back.lcmlog";
  convert(bag_, types_, back, "lz4", said);
  EXPECT_EQ(read_bytes(back), read_bytes(all_));
  EXPECT_EQ(verify(bag_, types_, said).findings, 0U) << said.str();
}

TEST_P(BagLogTest, IsReadByOthers) {
  converted(GetParam());
  const auto others = maploop::testing::run(
      {maploop::testing::source("tests/sensors/bag/other-readers"), bag_.string()});
  if (others.status == 77) GTEST_SKIP() << others.error;
  ASSERT_EQ(others.status, 0) << others.error;
  const json topics = json::parse(others.out)[bag_.string()]["topics"];
  const auto ours = sensors::summarize(bag_).topics;
  EXPECT_EQ(topics.size(), ours.size());
  for (const auto& topic : ours) {
    ASSERT_TRUE(topics.contains(topic.topic.name)) << topic.topic.name;
    EXPECT_EQ(topics[topic.topic.name]["messages"], topic.messages);
    EXPECT_EQ(topics[topic.topic.name]["type"], topic.topic.type);
  }
}

TEST_P(BagLogTest, IsReadByRos) {
  converted(GetParam());
  const auto ros = maploop::testing::run(
      {"/usr/bin/python3", maploop::testing::source("tests/tools/log/read_rosbag.py"),
       bag_.string()});
  if (ros.status == 77) GTEST_SKIP() << ros.error;
  ASSERT_EQ(ros.status, 0) << ros.error;
  const json read = json::parse(ros.out);
  EXPECT_EQ(read["compression"], GetParam());
  const auto ours = sensors::summarize(bag_).topics;
  EXPECT_EQ(read["topics"].size(), ours.size());
  for (const auto& topic : ours) {
    SCOPED_TRACE(topic.topic.name);
    const json& theirs = read["topics"][topic.topic.name];
    EXPECT_EQ(theirs["messages"], topic.messages);
    EXPECT_EQ(theirs["md5"], theirs["stated"]);
  }
  EXPECT_TRUE(contains(read["topics"]["/tf_static"]["text"], "child_frame_id: \"velo\""));
  EXPECT_TRUE(contains(read["topics"]["/map/road"]["text"], "Main Street, way 7: 0.75"));
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagLogTest, ::testing::Values("none", "lz4", "bz2"));

TEST_F(BagLogTest, IsReplayedAsTheLogIs) {
  converted();
  EXPECT_FALSE(sensors::is_bag(bag_)) << "its messages of ROS are there for others";
  EXPECT_GE(maploop::testing::expect_replayed_alike(bag_, all_), 1);
}

TEST_F(BagLogTest, ShowsWhatWasSentInTheTypesOfRos) {
  converted();
  forget_the_profile();
  EXPECT_TRUE(sensors::is_bag(bag_));
  const sensors::LogRecording log(all_);
  LidarScan scan;
  ASSERT_TRUE(log.source<LidarScan>(channel_names::velodyne)->next(scan));
  std::map<std::string, int> seen;
  const auto reader = sensors::open_messages(bag_, {});
  for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
    ASSERT_EQ(item, MessageReader::Item::message);
    const sensors::RecordedMessage& m = reader->message();
    const auto decoded = [&]<class T>(T message) {
      EXPECT_EQ(sensors::problem_of<T>(*m.topic), "") << m.topic->name;
      sensors::decode(*m.topic, m.data, message);
      return message;
    };
    ++seen[m.topic->name];
    if (m.topic->name == "/velodyne") {
      const auto cloud = decoded(sensors::RosPointCloud{});
      EXPECT_EQ(cloud.header.stamp, scan.stamp);
      EXPECT_EQ(cloud.width, scan.points.size());
      ASSERT_EQ(cloud.data.size(), scan.points.size() * sizeof(LidarPoint));
      EXPECT_EQ(std::memcmp(cloud.data.data(), scan.points.data(), cloud.data.size()), 0);
      EXPECT_EQ(cloud.fields.at(3).name, "intensity");
      EXPECT_EQ(cloud.fields.at(3).offset, 12U);
    } else if (m.topic->name == "/map/fix") {
      const auto fix = decoded(sensors::RosFix{});
      EXPECT_NEAR(fix.altitude, 3.0, 1e-6);
      EXPECT_EQ(fix.covariance_type, 3);
    } else if (m.topic->name == "/map/pose") {
      EXPECT_EQ(decoded(sensors::RosTwist{}).header.frame, "map");
    } else if (m.topic->name == "/tf") {
      const auto transform = decoded(sensors::RosTransforms{}).transforms.at(0);
      EXPECT_EQ(transform.parent + " " + transform.child,
                seen["/tf"] % 2 == 1 ? "map body" : "map body_enu");
      EXPECT_EQ(transform.T_parent_child.translation().z(), 3.0);
    } else if (m.topic->name == "/camera/left") {
      EXPECT_EQ(decoded(sensors::RosCompressedImage{}).format, "jpeg");
    } else if (m.topic->name == "/imu") {
      decoded(sensors::RosImu{});
    }
  }
  for (const char* topic : {"/camera/left", "/camera/right", "/gnss/fix", "/imu", "/map/fix",
                            "/map/pose", "/tf", "/tf_static", "/truth/fix", "/velodyne"})
    EXPECT_GT(seen[topic], 0) << topic;
}

TEST_F(BagLogTest, AnUnknownCompressionIsAnErrorAndNoFile) {
  EXPECT_TRUE(contains(error_of<std::invalid_argument>([&] { converted("zip"); }),
                       "'zip' is not a compression"));
  EXPECT_FALSE(std::filesystem::exists(bag_));
}

}  // namespace
}  // namespace maploop::lcm_log
