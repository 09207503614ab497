// Tests `maploop log` as users run it.
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/tools/log/small_log.h"

namespace maploop::lcm_log {
namespace {

using maploop::testing::ProcessResult;

ProcessResult log(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {maploop::testing::maploop_command(), "log"});
  return maploop::testing::run(arguments);
}

class LogCommand : public LogToolsTest {
 protected:
  // Makes b.lcmlog, whose HEALTH differs, and bad.lcmlog, one event of which is damaged.
  LogCommand() {
    auto events = drive_;
    events[1].data = health_bytes(3);
    record(file("b.lcmlog"), events);
    auto bytes = read_bytes(log_);
    bytes[offsets_[5]] ^= 1;
    write_bytes(file("bad.lcmlog"), bytes);
  }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
};

TEST_F(LogCommand, SaysWhatItFindsAndAnswersWithItsStatus) {
  const std::string a = file("a.lcmlog"), b = file("b.lcmlog"), bad = file("bad.lcmlog"),
                    missing = file("missing.lcmlog");
  struct Case {
    std::vector<std::string> arguments;
    int status;
    std::string said;  // on standard output, or on standard error after a failure
  };
  const std::vector<Case> cases{
      {{"info", a, "--json", file("a.json")}, 0, "maploop_lcm.nav_state_t"},
      {{"verify", a}, 0, "0 findings"},
      {{"verify", bad}, 1, "bytes are not an event"},
      {{"verify", missing}, 2, "missing.lcmlog"},
      {{"diff", a, b}, 0, "NAV_STATE: same"},  // HEALTH depends on the run
      {{"diff", a, b, "--channels", "HEALTH"}, 1, "message 0, thread_count"},
      {{"diff", a, bad}, 2, "is damaged at byte"},
      {{"diff", a, missing}, 2, "missing.lcmlog"},
      {{"diff", a, b, "--channels", "["}, 2, "not a regular expression"},
      {{"diff", a, b, "--channels", "NO"}, 2, "nothing was compared"},
      {{"split", bad, "--channels", "NAV_.*", "-o", file("part.lcmlog")}, 1, "8 of 23 events"},
      {{"merge", a, bad, "-o", file("merged.lcmlog")}, 1, "47 events of 2 logs"},
      {{"recover", bad, "-o", file("good.lcmlog")}, 0, ", event 5, between 2011-09-26"},
      {{"verify", file("good.lcmlog")}, 0, "0 findings"}};
  for (const Case& c : cases) {
    const ProcessResult result = log(c.arguments);
    EXPECT_EQ(result.status, c.status) << c.said << '\n' << result.out << result.error;
    EXPECT_TRUE(contains(c.status == 2 ? result.error : result.out, c.said)) << c.said;
    if (c.status == 0) {
      EXPECT_EQ(result.error, "") << "no progress line without a terminal";
    }
  }
  EXPECT_EQ(read_with_lcm(file("part.lcmlog")).size(), 8U);
  EXPECT_EQ(read_with_lcm(file("merged.lcmlog")).size(), 47U);
  EXPECT_TRUE(contains(log({"split", bad, "-o", file("part.lcmlog")}).error, "were left out"));
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
