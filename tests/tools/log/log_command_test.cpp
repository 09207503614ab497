// Tests `maploop log` as users run it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tests/tools/log/small_log.h"

namespace maploop::lcm_log {
namespace {

using maploop::testing::ProcessResult;

ProcessResult log(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {maploop::testing::maploop_command(), "log"});
  return maploop::testing::run(arguments);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class LogCommand : public ::testing::Test {
 protected:
  LogCommand() { record(folder_.path() / "a.lcmlog", small_drive()); }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  // Writes a copy of a.lcmlog with one damaged event.
  void make_damaged(const std::string& name) const {
    auto bytes = read_bytes(file("a.lcmlog"));
    bytes[event_offsets(small_drive())[5]] ^= 1;
    write_bytes(file(name), bytes);
  }

  const maploop::testing::TemporaryFolder folder_;
};

TEST_F(LogCommand, InfoTellsChannelsAndTypes) {
  const ProcessResult result = log({"info", file("a.lcmlog"), "--json", file("a.json")});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_TRUE(contains(result.out, "maploop_lcm.nav_state_t"));
  EXPECT_EQ(result.error, "");  // no progress line without a terminal
  EXPECT_FALSE(read_bytes(file("a.json")).empty());
}

TEST_F(LogCommand, VerifyAnswersWithItsStatus) {
  make_damaged("bad.lcmlog");
  EXPECT_EQ(log({"verify", file("a.lcmlog")}).status, 0);
  const ProcessResult bad = log({"verify", file("bad.lcmlog")});
  EXPECT_EQ(bad.status, 1);
  EXPECT_TRUE(contains(bad.out, "bytes are no event"));
  const ProcessResult missing = log({"verify", file("missing.lcmlog")});
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(contains(missing.error, "missing.lcmlog"));
}

TEST_F(LogCommand, DiffAnswersWithItsStatus) {
  auto events = small_drive();
  events[1].data = health_bytes(3);  // HEALTH depends on the run
  record(file("b.lcmlog"), events);
  EXPECT_EQ(log({"diff", file("a.lcmlog"), file("b.lcmlog")}).status, 0);
  const ProcessResult health =
      log({"diff", file("a.lcmlog"), file("b.lcmlog"), "--channels", "HEALTH"});
  EXPECT_EQ(health.status, 1);
  EXPECT_TRUE(contains(health.out, "message 0, thread_count")) << health.out;
  make_damaged("bad.lcmlog");
  EXPECT_EQ(log({"diff", file("a.lcmlog"), file("bad.lcmlog")}).status, 2);
  EXPECT_EQ(log({"diff", file("a.lcmlog"), file("missing.lcmlog")}).status, 2);
  EXPECT_EQ(log({"diff", file("a.lcmlog"), file("b.lcmlog"), "--channels", "["}).status, 2);
  EXPECT_EQ(log({"diff", file("a.lcmlog"), file("b.lcmlog"), "--channels", "NO"}).status, 2);
}

TEST_F(LogCommand, SplitAndMergeOfADamagedLogGoOnAndSaySo) {
  make_damaged("bad.lcmlog");
  const ProcessResult part =
      log({"split", file("bad.lcmlog"), "--channels", "NAV_.*", "-o", file("part.lcmlog")});
  EXPECT_EQ(part.status, 1);
  EXPECT_TRUE(contains(part.error, "damaged and were left out"));
  EXPECT_EQ(read_with_lcm(file("part.lcmlog")).size(), 8U);
  EXPECT_EQ(log({"merge", file("a.lcmlog"), file("bad.lcmlog"), "-o", file("m.lcmlog")}).status, 1);
  EXPECT_EQ(read_with_lcm(file("m.lcmlog")).size(), 47U);
}

TEST_F(LogCommand, RecoverAccountsForTheLoss) {
  make_damaged("bad.lcmlog");
  const ProcessResult result = log({"recover", file("bad.lcmlog"), "-o", file("good.lcmlog")});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_TRUE(contains(result.out, ", event 5, between 2011-09-26")) << result.out;
  EXPECT_EQ(log({"verify", file("good.lcmlog")}).status, 0);
}

TEST_F(LogCommand, TypesOfOthersBeforeAndAfterTheLog) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto folder = maploop::testing::real_data() / "lcm";
  const std::string recorded = (folder / "vlp16_position.lcm").string();
  const std::string type = (folder / "idsc.lcm").string();
  for (const auto& arguments :
       {std::vector{std::string("info"), recorded, std::string("--types"), type},
        std::vector{std::string("info"), std::string("--types"), type, recorded}}) {
    const ProcessResult result = log(arguments);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_TRUE(contains(result.out, "idsc.BinaryBlob")) << result.out;
  }
}

TEST_F(LogCommand, TwoRunsOfTheDriveHaveTheSameData) {
  MAPLOOP_REQUIRE_DRIVE();
  const auto replay = [&](const std::string& name, const std::string& seed) {
    return maploop::testing::run({maploop::testing::maploop_command(), "replay",
                                  maploop::testing::drive_0013().string(), "--no-lcm", "--lockstep",
                                  "--seed", seed, "--record", file(name)})
        .status;
  };
  ASSERT_EQ(replay("one.lcmlog", "1"), 0);
  ASSERT_EQ(replay("two.lcmlog", "1"), 0);
  ASSERT_EQ(replay("three.lcmlog", "2"), 0);
  const ProcessResult sound = log({"verify", file("one.lcmlog")});
  EXPECT_EQ(sound.status, 0) << sound.out;
  EXPECT_TRUE(contains(sound.out, ", 0 of unknown type"));
  EXPECT_EQ(log({"diff", file("one.lcmlog"), file("two.lcmlog")}).status, 0);
  const ProcessResult other = log({"diff", file("one.lcmlog"), file("three.lcmlog")});
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(contains(other.out, "VO: same, 144 messages")) << other.out;
  EXPECT_TRUE(contains(other.out, "message 0, latitude")) << other.out;
}

}  // namespace
}  // namespace maploop::lcm_log
