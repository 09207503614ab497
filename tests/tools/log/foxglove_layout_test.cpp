// Tests that the layout for Foxglove shows topics and fields that we write.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "tests/support/real_data.h"
#include "tools/log/foxglove_messages.h"
#include "tools/log/message_json.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;

// The types of topics, by their names.
std::map<std::string, std::string> written_topics() {
  std::map<std::string, std::string> topics{{"NAV_STATE", "maploop_lcm.nav_state_t"},
                                            {"ODOM_STATE", "maploop_lcm.odom_state_t"},
                                            {"MAP_MATCH", "maploop_lcm.map_match_t"}};
  for (const auto channel :
       {channel_names::nav_state, channel_names::odom_state, channel_names::gnss_fix,
        channel_names::truth, channel_names::velodyne, channel_names::map_match}) {
    for (const FoxgloveTopic& topic : foxglove_topics(channel))
      topics.emplace(topic.name, topic.schema_name);
  }
  return topics;
}

std::string schema_of(const std::string& name) {
  const schema::Type* own = schema::own_schema().find(name);
  return own != nullptr ? json_schema(*own) : foxglove_schema(name);
}

class FoxgloveLayout : public ::testing::Test {
 protected:
  FoxgloveLayout() {
    std::ifstream file(maploop::testing::source("tools/log/foxglove_layout.json"));
    layout_ = json::parse(file);
  }
  const json& panel(const char* name) const { return layout_.at("configById").at(name); }

  json layout_;
  std::map<std::string, std::string> topics_ = written_topics();
};

TEST_F(FoxgloveLayout, MapAndSceneShowTopicsThatAreWritten) {
  EXPECT_TRUE(topics_.contains(panel("map!maploop").at("followTopic")));
  for (const auto& [topic, color] : panel("map!maploop").at("topicColors").items())
    EXPECT_EQ(topics_[topic], "foxglove.LocationFix") << topic;
  for (const auto& [topic, settings] : panel("3D!maploop").at("topics").items())
    EXPECT_TRUE(topics_.contains(topic)) << topic;
}

TEST_F(FoxgloveLayout, PlotsShowFieldsThatAreWritten) {
  std::size_t paths = 0;
  for (const char* name : {"Plot!variances", "Plot!motion", "StateTransitions!maploop"}) {
    for (const json& path : panel(name).at("paths")) {
      const auto value = path.at("value").get<std::string>();
      const std::string topic = value.substr(0, value.find('.'));
      ASSERT_TRUE(topics_.contains(topic)) << value;
      const std::string rest = value.substr(topic.size() + 1);
      const json schema = json::parse(schema_of(topics_[topic]));
      EXPECT_TRUE(schema.at("properties").contains(rest.substr(0, rest.find('[')))) << value;
      ++paths;
    }
  }
  EXPECT_EQ(paths, 8U);
}

void collect_panels(const json& node, std::set<std::string>& panels) {
  if (node.is_string()) {
    panels.insert(node.get<std::string>());
  } else {
    collect_panels(node.at("first"), panels);
    collect_panels(node.at("second"), panels);
  }
}

TEST_F(FoxgloveLayout, EachPanelHasAPlace) {
  std::set<std::string> placed, configured;
  collect_panels(layout_.at("layout"), placed);
  for (const auto& [name, config] : layout_.at("configById").items()) configured.insert(name);
  EXPECT_EQ(placed, configured);
}

}  // namespace
}  // namespace maploop::lcm_log
