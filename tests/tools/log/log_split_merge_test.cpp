// Tests splitting and merging of logs, read back by LCM itself.
#include "tools/log/log_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "tests/tools/log/log_tools_fixture.h"
#include "tools/log/log_info.h"
#include "tools/log/log_merge.h"

namespace maploop::lcm_log {
namespace {

SplitParameters to(const path& output) {
  SplitParameters parameters;
  parameters.output = output;
  return parameters;
}

TEST_F(LogToolsTest, SplitByTimeTakesTheStartAndLeavesTheEnd) {
  SplitParameters parameters = to(out_);
  parameters.start_s = 0.05;
  parameters.end_s = 0.1;
  const SplitResult result = split(log_, types(), parameters);
  EXPECT_EQ(result.events_taken, 5U);
  EXPECT_EQ(read_with_lcm(out_), std::vector<TestEvent>(drive_.begin() + 5, drive_.begin() + 10));
}

TEST_F(LogToolsTest, SplitByChannelMatchesWholeNames) {
  SplitParameters parameters = to(out_);
  parameters.channels = ChannelFilter("X|I.*");
  split(log_, types(), parameters);
  for (const TestEvent& e : read_with_lcm(out_))
    EXPECT_TRUE(e.channel == "X" || e.channel == "IMU");
  EXPECT_EQ(read_with_lcm(out_).size(), 8U);
  EXPECT_TRUE(contains(error_of<std::invalid_argument>([] { ChannelFilter("("); }), "'('"));
}

TEST(ChannelFilter, MatchesWholeNames) {
  ChannelFilter filter("VO|(NAV|IMU)_?[A-Z]*");
  for (const char* name : {"VO", "NAV_STATE", "IMU"}) EXPECT_TRUE(filter.takes(name)) << name;
  for (const char* name : {"VOX", "xVO", "NAV_state", ""}) EXPECT_FALSE(filter.takes(name)) << name;
  EXPECT_TRUE(ChannelFilter("a|ab").takes("ab"));
  EXPECT_TRUE(ChannelFilter(".*").takes(std::string(999, 'x')));
  EXPECT_TRUE(ChannelFilter().takes("HEALTH"));
}

TEST_F(LogToolsTest, PiecesJoinedAreTheLogAgain) {
  const std::vector<std::pair<std::string, std::size_t>> cases{
      {"0.1s", 3}, {"0.05s", 5}, {"0.01s", 24}, {"1h", 1}, {"4kB", 3}, {"0.1kB", 24}};
  for (const auto& [every, pieces] : cases) {
    SplitParameters parameters = to(out_);
    parameters.every = parse_piece_limit(every);
    const SplitResult result = split(log_, types(), parameters);
    EXPECT_EQ(result.files.size(), pieces) << every;
    EXPECT_EQ(result.files[0].filename(), "out.000.lcmlog");
    std::vector<TestEvent> joined;
    for (const path& piece : result.files) {
      for (TestEvent& event : read_with_lcm(piece)) joined.push_back(std::move(event));
    }
    EXPECT_EQ(joined, drive_) << every;
  }
}

TEST_F(LogToolsTest, CompressedPiecesAreNamedForBoth) {
  SplitParameters parameters = to(folder_.path() / "out.lcmlog.gz");
  parameters.every = parse_piece_limit("0.1s");
  const SplitResult result = split(log_, types(), parameters);
  EXPECT_EQ(result.files[1].filename(), "out.001.lcmlog.gz");
  EXPECT_EQ(read_bytes(result.files[1])[0], 0x1f);
  EXPECT_EQ(read_info(result.files[1], types()).events, 10U);
}

TEST(PieceLimit, IsANumberWithItsUnit) {
  EXPECT_EQ(parse_piece_limit("1.5min").seconds, 90.0);
  EXPECT_EQ(parse_piece_limit("2GB").bytes, 2'000'000'000U);
  for (const char* wrong : {"", "s", "10", "10 s", "-5s", "0s", "nans", "infs", "1e300GB", "5mb"}) {
    EXPECT_TRUE(contains(error_of<std::invalid_argument>([&] { parse_piece_limit(wrong); }),
                         std::string("'") + wrong + "'"))
        << wrong;
  }
}

TEST_F(LogToolsTest, SplitThatTakesNothingOrWouldOverwriteItsInputWritesNothing) {
  SplitParameters parameters = to(out_);
  parameters.start_s = 1000.0;
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { split(log_, types(), parameters); }),
                       "none of the 24 events"));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_TRUE(contains(error_of<std::invalid_argument>([&] { split(log_, types(), to(log_)); }),
                       "name another output file"));
  EXPECT_EQ(read_with_lcm(log_), drive_);
}

TEST_F(LogToolsTest, OutputThatCannotBeWrittenLeavesWhatWasThere) {
  EXPECT_TRUE(contains(
      error_of<std::runtime_error>([&] { split(log_, types(), to("/nowhere/out.lcmlog")); }),
      "/nowhere/out.lcmlog"));
  for (const path& no_file : {path("/dev/null"), folder_.path()}) {
    EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { split(log_, types(), to(no_file)); }),
                         "no regular file"));
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  record(out_, {drive_[0]});
  SplitParameters parameters = to(out_);
  parameters.start_s = 1000.0;
  EXPECT_THROW(split(log_, types(), parameters), std::runtime_error);
  EXPECT_EQ(read_with_lcm(out_).size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(out_.string() + ".part"));
}

TEST_F(LogToolsTest, SplitOfADamagedLogSaysSo) {
  damage(offsets_[3], 0xff);
  const SplitResult result = split(log_, types(), to(out_));
  EXPECT_EQ(result.damages, 1U);
  EXPECT_EQ(result.damaged_bytes, offsets_[4] - offsets_[3]);
  EXPECT_EQ(result.events_taken, 23U);
}

TEST_F(LogToolsTest, MergeIsByTimeAndStable) {
  const auto event = [](const char* name, std::int64_t ms) {
    return TestEvent{name, kTestStart + 1000 * ms, {1, 2, 3}};
  };
  const path a = folder_.path() / "1.lcmlog", b = folder_.path() / "2.lcmlog";
  record(a, {event("A1", 0), event("A2", 10), event("A3", 10), event("A4", 30)});
  record(b, {event("B1", 0), event("B2", 10), event("B3", 20)});
  const auto order = [&](std::vector<path> logs) {
    EXPECT_EQ(merge(logs, types(), out_).events, 7U);
    std::string names;
    for (const TestEvent& e : read_with_lcm(out_)) names += e.channel + " ";
    return names;
  };
  EXPECT_EQ(order({a, b}), "A1 B1 A2 A3 B2 B3 A4 ");
  EXPECT_EQ(order({b, a}), "B1 A1 B2 A2 A3 B3 A4 ");
}

TEST_F(LogToolsTest, SplitChannelsMergedAreTheLogAgain) {
  SplitParameters states = to(folder_.path() / "states.lcmlog.gz");
  states.channels = ChannelFilter("NAV_STATE");
  SplitParameters others = to(folder_.path() / "others.lcmlog");
  others.channels = ChannelFilter(std::set<std::string, std::less<>>{"NAV_STATE"});
  split(log_, types(), states);
  split(log_, types(), others);
  const std::vector<path> parts{states.output, others.output};
  merge(parts, types(), out_);
  EXPECT_EQ(read_with_lcm(out_), drive_);
  EXPECT_EQ(read_bytes(out_), read_bytes(log_));
  EXPECT_THROW(merge(parts, types(), others.output), std::invalid_argument);
}

TEST_F(LogToolsTest, MergeOfRealLogsLosesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const path folder = maploop::testing::real_data() / "lcm";
  const std::vector<path> logs{folder / "vlp16_and_wheels.lcm", folder / "vlp16_position.lcm"};
  EXPECT_EQ(merge(logs, types(), out_).events, 172U);
  const auto merged = read_with_lcm(out_);
  ASSERT_EQ(merged.size(), 172U);
  EXPECT_TRUE(std::is_sorted(merged.begin(), merged.end(),
                             [](const auto& a, const auto& b) { return a.time_us < b.time_us; }));
}

}  // namespace
}  // namespace maploop::lcm_log
