// Tests `log convert` to MCAP and back: the file is read by our own reader, and by npm's.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/conversions.h"
#include "sensors/bag/message_reader.h"
#include "sensors/replay/log_recording.h"
#include "tests/support/process.h"
#include "tests/tools/log/replayed_log.h"
#include "tests/tools/log/small_log.h"
#include "tools/log/log_tools.h"
#include "tools/log/message_json.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;
using sensors::MessageReader;

class LogConvert : public LogToolsTest {
 protected:
  std::string converted() {
    std::ostringstream said;
    convert(log_, types_, mcap_, "lz4", said);
    return said.str();
  }

  const path mcap_ = folder_.path() / "out.mcap";
};

TEST_F(LogConvert, KeepsEachMessageAndShowsPoses) {
  EXPECT_TRUE(contains(converted(), "out.mcap: 24 messages of 5 channels; 5 of unknown types"));
  const auto reader = sensors::open_messages(mcap_, {});
  std::map<std::string, std::vector<json>> messages;
  for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
    ASSERT_EQ(item, MessageReader::Item::message);
    const auto& m = reader->message();
    if (m.topic->encoding == "lcm") continue;
    EXPECT_EQ(m.topic->encoding, "json");
    EXPECT_TRUE(json::accept(m.topic->definition));
    messages[m.topic->name].push_back(json::parse(m.data.begin(), m.data.end()));
  }
  EXPECT_EQ(messages["NAV_STATE"].size(), 8U);
  EXPECT_EQ(messages["HEALTH"].size(), 4U);
  EXPECT_EQ(messages["IMU"].size(), 4U);
  EXPECT_EQ(messages["X"].size(), 3U);
  ASSERT_EQ(messages["/map/pose"].size(), 8U);
  const json& pose = messages["/map/pose"][1];
  EXPECT_EQ(pose["frame_id"], "map");
  EXPECT_NEAR(pose["pose"]["position"]["x"], 0.3, 1e-9);
  EXPECT_NEAR(messages["/map/fix"][1]["altitude"], 3.0, 1e-6);
  EXPECT_EQ(messages["/tf"][0]["child_frame_id"], "body");
  const auto first = sensors::summarize(mcap_).topics.front();
  EXPECT_EQ(to_nanoseconds(first.first), 1000 * test_start);
}

TEST_F(LogConvert, GivesTheSameLogBack) {
  converted();
  std::ostringstream said;
  const path back = folder_.path() / "back.lcmlog";
  EXPECT_EQ(convert(mcap_, types_, back, "lz4", said).events, drive_.size());
  EXPECT_TRUE(contains(said.str(), "24 messages of 5 channels\n")) << said.str();
  EXPECT_EQ(read_bytes(back), read_bytes(log_));
}

TEST_F(LogConvert, KeepsTheOrderOfALogWhoseTimeGoesBack) {
  auto events = drive_;
  events[7].time_us -= 3'600'000'000;
  events[8].time_us -= 1'800'000'000;
  record(log_, events);
  converted();
  std::ostringstream said;
  convert(mcap_, types_, out_, "lz4", said);
  EXPECT_EQ(read_with_lcm(out_), events);
}

TEST_F(LogConvert, EveryToolReadsAndWritesMcapFiles) {
  converted();
  std::ostringstream said;
  EXPECT_EQ(verify(mcap_, types_, said).findings, 0U) << said.str();
  EXPECT_TRUE(diff(mcap_, log_, types_, matching(".*"), said)) << said.str();
  const path part = folder_.path() / "part.mcap", again = folder_.path() / "again.mcap";
  split(mcap_, types_, {.end_s = 0.05, .output = part}, said);
  EXPECT_EQ(read_log(part, types_, [](const LogEvent&) {}).events, 5U);
  const std::vector<path> both{part, log_};
  EXPECT_EQ(merge(both, types_, again, said).events, 29U);
  EXPECT_EQ(read_log(again, types_, [](const LogEvent&) {}).events, 29U);
}

TEST_F(LogConvert, RecoversWhatACutFileHas) {
  std::vector<TestEvent> events;
  events.reserve(10);
  for (int i = 0; i < 10; ++i)
    events.push_back({"X", test_start + 500'000 * i, unknown_bytes(20'000, std::uint8_t(i))});
  record(log_, events);
  converted();
  auto bytes = read_bytes(mcap_);
  bytes.resize(bytes.size() / 2);
  write_bytes(mcap_, bytes);
  std::ostringstream said;
  const Recovery rescued = recover(mcap_, types_, out_, said);
  EXPECT_EQ(rescued.losses, 1U) << said.str();
  const auto read = read_with_lcm(out_);
  EXPECT_EQ(read.size(), rescued.events);
  EXPECT_GE(read.size(), 3U);
  EXPECT_LT(read.size(), 10U);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i], events[i]);
}

// It has one message of every sensor, also an image and a cloud, and one of the map matcher.
TEST_F(LogConvert, IsReadByOthersWhoFindFoxglovesSchemas) {
  const path sensors_log = maploop::testing::source("tests/fuzz/corpus/recording/sensors.lcmlog");
  std::ostringstream said;
  const path match_log = folder_.path() / "match.lcmlog";
  record(match_log, {{"MAP_MATCH", test_start, map_match_bytes()}});
  const std::vector<path> logs{log_, sensors_log, match_log};
  merge(logs, types_, mcap_, said);
  const auto others = maploop::testing::run(
      {maploop::testing::source("tests/sensors/bag/other-readers"), mcap_.string()});
  if (others.status == 77) GTEST_SKIP() << others.error;
  ASSERT_EQ(others.status, 0) << others.error;
  const json topics = json::parse(others.out)[mcap_.string()]["topics"];
  const auto ours = sensors::summarize(mcap_).topics;
  for (const auto& topic : ours) {
    ASSERT_TRUE(topics.contains(topic.topic.name)) << topic.topic.name;
    EXPECT_EQ(topics[topic.topic.name]["messages"], topic.messages);
    EXPECT_EQ(topics[topic.topic.name]["type"], topic.topic.type);
    EXPECT_EQ(topics[topic.topic.name]["encoding"], topic.topic.encoding);
  }
  EXPECT_EQ(topics.size(), ours.size());
  for (const char* shown : {"/camera/left", "/camera/right", "/gnss/fix", "/map/fix", "/map/pose",
                            "/map/road", "/tf", "/tf_static", "/truth/fix", "/velodyne"})
    EXPECT_EQ(topics[shown]["strange"], "") << shown;
}

TEST_F(LogConvert, AnMcapFileIsReplayedAsTheLogIs) {
  const path sensors_log = maploop::testing::source("tests/fuzz/corpus/recording/sensors.lcmlog");
  std::ostringstream said;
  convert(sensors_log, types_, mcap_, "lz4", said);
  EXPECT_FALSE(sensors::is_bag(mcap_)) << "its sensors are not in ROS's types";
  EXPECT_EQ(maploop::testing::expect_replayed_alike(mcap_, sensors_log), 1);
  const auto samples = sensors::LogRecording(mcap_).source<ImuSample>(channel_names::imu);
  ImuSample sample;
  while (samples->next(sample)) continue;
  EXPECT_EQ(samples->report().delivered, 3U);
}

TEST_F(LogConvert, OfNothingIsAnErrorAndNoFile) {
  record(log_, {});
  const std::string error = error_of<std::runtime_error>([&] { converted(); });
  EXPECT_TRUE(contains(error, "has no messages")) << error;
  EXPECT_FALSE(std::filesystem::exists(mcap_));
}

TEST(JsonSchema, DescribesWhatTheMessageHas) {
  const auto& types = schema::own_schema();
  const json schema = json::parse(json_schema(*types.find("maploop_lcm.nav_state_t")));
  EXPECT_EQ(schema["title"], "maploop_lcm.nav_state_t");
  EXPECT_EQ(schema["properties"]["status"]["type"], "integer");
  EXPECT_EQ(schema["properties"]["covariance"]["items"]["items"]["type"], "number");
  EXPECT_EQ(schema["properties"]["header"]["properties"]["stamp_ns"]["type"], "integer");
}

}  // namespace
}  // namespace maploop::lcm_log
