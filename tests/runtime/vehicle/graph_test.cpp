#include "runtime/vehicle/graph.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

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
  for (const Stage& stage : stages::all) names.insert(stage.name);
  for (const Channel& channel : channels::all) {
    EXPECT_EQ(names.count(channel.from), 1u) << channel.name;
  }
  for (const EdgeSpec& edge : edges::all) {
    const auto arrow = edge.name.find(" -> ");
    ASSERT_NE(arrow, std::string_view::npos) << edge.name;
    EXPECT_EQ(names.count(edge.name.substr(arrow + 4)), 1u) << edge.name;
    EXPECT_GT(edge.capacity, 0u) << edge.name;
  }
}

TEST(Graph, ADeadlineLeavesRoomForTheBudget) {
  for (const Stage& stage : stages::all) {
    if (stage.deadline == Duration::zero()) continue;
    EXPECT_GE(stage.deadline, stage.budget) << stage.name;
  }
}

}  // namespace
}  // namespace maploop::vehicle
