// Tests runs that announce themselves on one bus.
#include "runtime/vehicle/output/runs.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>
#include <maploop_lcm/run_t.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::vehicle {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

maploop_lcm::run_t said(const std::string& id, bool ended = false) {
  maploop_lcm::run_t message{};
  message.id = id;
  message.what = "replay of a drive";
  message.ended = ended ? 1 : 0;
  return message;
}

std::vector<std::string> ids(const RunsHeard& runs, Duration now) {
  std::vector<std::string> all;
  for (const Run& run : runs.present(now)) all.push_back(run.id);
  return all;
}

using Ids = std::vector<std::string>;

TEST(RunsHeard, EndBySayingSoOrBySilence) {
  RunsHeard runs;
  runs.take(said("0000000b"), seconds(1));
  runs.take(said("0000000a"), seconds(2));
  EXPECT_EQ(ids(runs, seconds(2)), (Ids{"0000000a", "0000000b"}));
  EXPECT_EQ(ids(runs, seconds(5)), Ids{"0000000a"}) << "one is silent";
  runs.take(said("0000000a", true), seconds(5));
  EXPECT_EQ(ids(runs, seconds(5)), Ids{});
}

TEST(RunsHeard, WhoeverFloodsTheChannelTakesNoMemory) {
  RunsHeard runs;
  for (int i = 0; i < 1000; ++i) runs.take(said("000" + std::to_string(10000 + i)), seconds(1));
  EXPECT_EQ(runs.present(seconds(1)).size(), 16u);
  runs.take(said("no id"), seconds(9));
  EXPECT_TRUE(runs.present(seconds(9)).empty());
  runs.take(said("00000001"), seconds(9));
  EXPECT_EQ(ids(runs, seconds(9)), Ids{"00000001"}) << "silent ones make room";
}

TEST(Run, HasAnIdOfItsOwnAndATextForTerminals) {
  const vehicle::Run run = new_run("replay of a\x1b[2Jdrive");
  EXPECT_EQ(run.id.size(), 8u);
  EXPECT_NE(run.id, new_run("").id);
  EXPECT_EQ(to_text(run), run.id + " (replay of a?[2Jdrive)");
}

TEST(RunPresence, TwoOnOneBusWarnEachOtherOnce) {
  lcm::LCM lcm("memq://");
  ASSERT_TRUE(lcm.good());
  std::vector<std::string> first_says, second_says;
  RunPresence first(lcm, new_run("replay of one"),
                    [&](const std::string& text) { first_says.push_back(text); });
  for (int i = 0; i < 3; ++i) first.update();
  EXPECT_TRUE(first_says.empty()) << "alone";
  std::optional<RunPresence> second;
  second.emplace(lcm, new_run("replay of two"),
                 [&](const std::string& text) { second_says.push_back(text); });
  const std::string second_id = second->run().id;
  // The second announces itself at once, the first again within a second.
  for (int i = 0; i < 1000 && (first_says.empty() || second_says.empty()); ++i) {
    second->update();
    first.update();
    lcm.handleTimeout(10);
  }
  second.reset();
  for (int i = 0; i < 3; ++i) first.update();
  ASSERT_EQ(first_says.size(), 1u);
  ASSERT_EQ(second_says.size(), 1u);
  EXPECT_THAT(first_says[0], HasSubstr(second_id + " (replay of two)"));
  EXPECT_THAT(first_says[0], HasSubstr("--lcm-url"));
  EXPECT_THAT(second_says[0], HasSubstr("(replay of one)"));
}

}  // namespace
}  // namespace maploop::vehicle
