// Tests what viewers show of a match.
#include "tools/log/match_scene.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/tools/log/small_log.h"
#include "tools/log/foxglove_messages.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;

maploop_lcm::map_match_t some_match() {
  maploop_lcm::map_match_t match{};
  EXPECT_TRUE(schema::checked_decode(schema::own_schema(), map_match_bytes(), match));
  return match;
}

std::optional<json> shown(const std::vector<std::uint8_t>& data) {
  std::optional<json> scene;
  show_in_foxglove({.channel = "MAP_MATCH", .data = data}, schema::own_schema(),
                   [&](const FoxgloveMessage& message) {
                     EXPECT_EQ(message.topic, "/map/road");
                     EXPECT_EQ(message.schema_name, "foxglove.SceneUpdate");
                     scene = json::parse(message.json);
                   });
  return scene;
}

TEST(MatchScene, TheEllipseIsOfThreeStandardDeviations) {
  const auto scene = match_scene(some_match());
  EXPECT_EQ(scene.frame, "body_enu");
  double east = 0.0, north = 0.0;
  for (const Eigen::Vector3d& p : scene.lines.at(0).points) {
    east = std::max(east, std::abs(p.x()));
    north = std::max(north, std::abs(p.y()));
  }
  EXPECT_TRUE(scene.lines[0].closed);
  EXPECT_NEAR(east, 6.0, 1e-9);
  EXPECT_NEAR(north, 3.0, 1e-9);
}

TEST(MatchScene, TheRoadBendsThroughTheMatchedPoint) {
  const auto scene = match_scene(some_match());
  ASSERT_EQ(scene.lines.size(), 4U);
  const auto& middle = scene.lines[1].points;
  const auto& right = scene.lines[3].points;
  EXPECT_NEAR((middle[10] - Eigen::Vector3d(3.0, 0.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(right[10].x() - middle[10].x(), 2.5, 1e-9);
  // An arc of 15 m turns by 0.1 rad: it ends 0.75 m to the right of its tangent, at both ends.
  EXPECT_NEAR(middle.back().x(), 3.75, 0.01);
  EXPECT_NEAR(middle.back().y(), 15.0, 0.05);
  EXPECT_NEAR(middle.front().x(), 3.75, 0.01);
}

TEST(MatchScene, IsWrittenAsFoxglovesSceneUpdate) {
  const auto scene = shown(map_match_bytes());
  ASSERT_TRUE(scene);
  const json& entity = scene->at("entities").at(0);
  EXPECT_EQ(entity["frame_id"], "body_enu");
  EXPECT_EQ(entity["lines"].size(), 4U);
  EXPECT_EQ(entity["lines"][0]["type"], 1);
  EXPECT_EQ(entity["lines"][1]["type"], 0);
  EXPECT_EQ(entity["lines"][1]["points"][10]["x"], 3.0);
  EXPECT_EQ(entity["texts"][0]["text"], "Main Street, way 7: 0.75");
}

TEST(MatchScene, OffTheRoadThereIsTheEllipseOnly) {
  auto match = some_match();
  match.on_road = false;
  EXPECT_EQ(match_scene(match).lines.size(), 1U);
}

TEST(MatchScene, ARefusedStateOrBadTextDoesNoHarm) {
  auto match = some_match();
  match.refusal = maploop_lcm::map_match_t::NOT_FINITE;
  EXPECT_FALSE(shown(schema::encoded(match)));
  match = some_match();
  match.candidates[0].road = "\xff";
  EXPECT_TRUE(shown(schema::encoded(match)));
}

}  // namespace
}  // namespace maploop::lcm_log
