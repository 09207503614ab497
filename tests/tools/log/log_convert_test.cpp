// Tests `log convert`: the MCAP file is read back by our own reader and by npm's.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sensors/bag/message_reader.h"
#include "tests/support/process.h"
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
    convert(log_, types_, mcap_, said);
    return said.str();
  }

  const path mcap_ = folder_.path() / "out.mcap";
};

TEST_F(LogConvert, KeepsEachMessageAndShowsPoses) {
  EXPECT_TRUE(contains(converted(), "out.mcap: 43 messages of 7 channels; 5 of unknown types"));
  const auto reader = sensors::open_messages(mcap_, {});
  std::map<std::string, std::vector<json>> messages;
  for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
    ASSERT_EQ(item, MessageReader::Item::message);
    const auto& m = reader->message();
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

TEST_F(LogConvert, IsReadByOthers) {
  converted();
  const auto others = maploop::testing::run(
      {maploop::testing::source("tests/sensors/bag/other-readers"), mcap_.string()});
  if (others.status == 77) GTEST_SKIP() << others.error;
  ASSERT_EQ(others.status, 0) << others.error;
  const json topics = json::parse(others.out)[mcap_.string()]["topics"];
  for (const auto& topic : sensors::summarize(mcap_).topics) {
    ASSERT_TRUE(topics.contains(topic.topic.name)) << topic.topic.name;
    EXPECT_EQ(topics[topic.topic.name]["messages"], topic.messages);
    EXPECT_EQ(topics[topic.topic.name]["type"], topic.topic.type);
    EXPECT_EQ(topics[topic.topic.name]["encoding"], "json");
  }
  EXPECT_EQ(topics.size(), 7U);
}

TEST_F(LogConvert, OfNothingThatIsKnownIsAnErrorAndNoFile) {
  record(log_, {{"RAW", test_start, unknown_bytes(20, 1)}});
  const std::string error = error_of<std::runtime_error>([&] { converted(); });
  EXPECT_TRUE(contains(error, "has no message of a known type")) << error;
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
