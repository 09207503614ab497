#include "runtime/vehicle/graph/graph.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

#include "runtime/vehicle/graph/rings.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

TEST(Graph, ThePageIsMadeFromTheTable) {
  std::ostringstream page;
  page << std::ifstream(maploop::testing::source("runtime/vehicle/GRAPH.md")).rdbuf();
  EXPECT_EQ(page.str(), graph_page()) << "write graph_page() to runtime/vehicle/GRAPH.md:\n"
                                      << graph_page();
}

TEST(Graph, EveryEdgeAndChannelComesFromAStage) {
  std::set<std::string_view> names;
  for (const StageSpec& stage : stages::all) names.insert(stage.name);
  for (const ChannelSpec& channel : channels::all) {
    EXPECT_EQ(names.count(channel.from), 1u) << channel.name;
  }
  std::set<std::string> rings_seen;
  const auto look = [&](const auto& ring) {
    EXPECT_EQ(names.count(ring.from.name), 1u) << ring.name();
    EXPECT_EQ(names.count(ring.to.name), 1u) << ring.name();
    EXPECT_GT(ring.capacity, 0u) << ring.name();
    EXPECT_TRUE(rings_seen.insert(ring.name()).second) << ring.name() << " is declared twice";
  };
  std::apply([&](const auto&... ring) { (look(ring), ...); }, rings::all);
}

TEST(Graph, ARingWithoutProducerOrConsumerIsFoundAtConstruction) {
  Rings rings(std::tie(rings::imu_fusion), {"imu", "fusion"}, {});
  EXPECT_THROW(rings.check(), std::logic_error);
  ASSERT_NE(rings.consumer(rings::imu_fusion), nullptr);
  EXPECT_THROW(rings.check(), std::logic_error);
  EXPECT_EQ(rings.outputs(rings::imu_fusion).rings().size(), 1u);
  rings.check();
}

TEST(Graph, AVehicleHasTheRingsBetweenItsOwnStages) {
  Rings without(rings::all, {"stereo", "fusion"}, {});
  EXPECT_NE(without.consumer(rings::stereo_fusion), nullptr);
  EXPECT_EQ(without.consumer(rings::lidar_fusion), nullptr);
  Rings with(rings::all, {"stereo", "lidar", "fusion", "mapmatch"}, {});
  EXPECT_EQ(with.consumer(rings::stereo_fusion), nullptr) << "the LiDAR odometry is fused";
  EXPECT_NE(with.consumer(rings::lidar_fusion), nullptr);
  EXPECT_EQ(with.consumer(rings::mapmatch_fusion), nullptr) << "the map does not feed back";
  Rings closed(rings::all, {"fusion", "mapmatch"}, {RingNeeds::feedback});
  EXPECT_NE(closed.consumer(rings::mapmatch_fusion), nullptr);
}

TEST(Graph, ADeadlineLeavesRoomForTheBudget) {
  for (const StageSpec& stage : stages::all) {
    if (stage.deadline == Duration::zero()) continue;
    EXPECT_GE(stage.deadline, stage.budget) << stage.name;
  }
}

}  // namespace
}  // namespace maploop::vehicle
