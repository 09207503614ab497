// Tests splitting and merging of logs, read back by LCM itself.
#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>

#include "tests/tools/log/small_log.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

class LogPieces : public LogToolsTest {
 protected:
  LogSummary split_to(const path& output, SplitParameters parameters = {}) {
    parameters.output = output;
    said_.str("");
    return split(log_, types_, parameters, said_);
  }

  bool says(const std::string& text) const { return contains(said_.str(), text); }

  std::ostringstream said_;
};

TEST_F(LogPieces, SplitByTimeTakesTheStartAndLeavesTheEnd) {
  split_to(out_, {.start_s = 0.05, .end_s = 0.1});
  EXPECT_TRUE(says("5 of 24 events written to ")) << said_.str();
  EXPECT_EQ(read_with_lcm(out_), std::vector<TestEvent>(drive_.begin() + 5, drive_.begin() + 10));
}

TEST_F(LogPieces, SplitByChannelMatchesWholeNames) {
  split_to(out_, {.channels = matching("X|I.*")});
  const auto events = read_with_lcm(out_);
  EXPECT_EQ(events.size(), 8U);
  for (const TestEvent& e : events) EXPECT_TRUE(e.channel == "X" || e.channel == "IMU");
}

TEST_F(LogPieces, EachPartBeginsWithTheCalibrationBeforeIt) {
  const TestEvent calibration{"CALIBRATION", test_start, unknown_bytes(20, 1)};
  auto events = drive_;
  events.insert(events.begin(), calibration);
  record(log_, events);
  const auto calibrated = [&](std::size_t first, std::size_t end) {
    std::vector<TestEvent> part(events.begin() + static_cast<std::ptrdiff_t>(first),
                                events.begin() + static_cast<std::ptrdiff_t>(end));
    part.insert(part.begin(), {calibration.channel, part.front().time_us, calibration.data});
    return part;
  };
  split_to(out_, {.start_s = 0.05, .end_s = 0.1});
  EXPECT_EQ(read_with_lcm(out_), calibrated(6, 11));
  EXPECT_TRUE(says("5 of 25 events") && says("with the calibration")) << said_.str();

  split_to(out_, {.start_s = 0.05, .end_s = 0.1, .channels = matching("NAV_.*|IMU")});
  for (const TestEvent& e : read_with_lcm(out_)) EXPECT_NE(e.channel, "CALIBRATION");

  split_to(out_, {.end_s = 0.05});
  EXPECT_EQ(read_with_lcm(out_), std::vector<TestEvent>(events.begin(), events.begin() + 6));

  split_to(folder_.path() / "piece.lcmlog", {.every = parse_piece_limit("0.1s")});
  EXPECT_EQ(read_with_lcm(folder_.path() / "piece.001.lcmlog"), calibrated(11, 21));
}

TEST(ChannelFilter, MatchesWholeNames) {
  const ChannelFilter filter = matching("VO|(NAV|IMU)_?[A-Z]*");
  for (const char* name : {"VO", "NAV_STATE", "IMU"}) EXPECT_TRUE(filter(name)) << name;
  for (const char* name : {"VOX", "xVO", "NAV_state", ""}) EXPECT_FALSE(filter(name)) << name;
  EXPECT_TRUE(matching("a|ab")("ab"));
  EXPECT_TRUE(matching(".*")(std::string(999, 'x')));
  EXPECT_TRUE(contains(error_of<std::invalid_argument>([] { matching("("); }), "'('"));
}

TEST_F(LogPieces, PiecesJoinedAreTheLogAgain) {
  const std::vector<std::pair<std::string, std::size_t>> cases{
      {"0.1s", 3}, {"0.05s", 5}, {"0.01s", 24}, {"1h", 1}, {"4kB", 3}, {"0.1kB", 24}};
  for (const auto& [every, pieces] : cases) {
    const path folder = folder_.path() / every;
    std::filesystem::create_directory(folder);
    split_to(folder / "out.lcmlog", {.every = parse_piece_limit(every)});
    const std::set<path> files{std::filesystem::directory_iterator(folder), {}};
    EXPECT_EQ(files.size(), pieces) << every;
    EXPECT_EQ(files.begin()->filename(), "out.000.lcmlog");
    std::vector<TestEvent> joined;
    for (const path& file : files) {
      for (TestEvent& event : read_with_lcm(file)) joined.push_back(std::move(event));
    }
    EXPECT_EQ(joined, drive_) << every;
  }
}

TEST_F(LogPieces, CompressedPiecesAreNamedForBoth) {
  split_to(folder_.path() / "out.lcmlog.gz", {.every = parse_piece_limit("0.1s")});
  const path second = folder_.path() / "out.001.lcmlog.gz";
  EXPECT_EQ(read_bytes(second)[0], 0x1f);
  EXPECT_EQ(read_log(second, types_, [](const LogEvent&) {}).events, 10U);
}

TEST(PieceLimit, IsANumberWithItsUnit) {
  EXPECT_EQ(parse_piece_limit("1.5min").most, 90.0);
  EXPECT_TRUE(parse_piece_limit("1.5min").is_time);
  EXPECT_EQ(parse_piece_limit("2GB").most, 2e9);
  EXPECT_FALSE(parse_piece_limit("2GB").is_time);
  for (const char* wrong : {"", "s", "10", "10 s", "-5s", "0s", "nans", "infs", "1e300GB", "5mb"}) {
    EXPECT_TRUE(contains(error_of<std::invalid_argument>([&] { parse_piece_limit(wrong); }),
                         std::string("'") + wrong + "'"))
        << wrong;
  }
}

TEST_F(LogPieces, SplitThatTakesNothingOrWouldOverwriteItsInputWritesNothing) {
  record(out_, {drive_[0]});
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { split_to(out_, {.start_s = 1000.0}); }),
                       "none of the 24 events"));
  EXPECT_EQ(read_with_lcm(out_).size(), 1U) << "what was there";
  EXPECT_FALSE(std::filesystem::exists(out_.string() + ".part"));
  EXPECT_TRUE(contains(error_of<std::invalid_argument>([&] { split_to(log_); }),
                       "name another output file"));
  EXPECT_EQ(read_with_lcm(log_), drive_);
}

TEST_F(LogPieces, OutputThatCannotBeWrittenIsNamed) {
  for (const path& no_file : {path("/nowhere/out.lcmlog"), folder_.path()}) {
    EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { split_to(no_file); }), no_file));
  }
  split_to("/dev/null");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(LogPieces, SplitOfADamagedLogSaysSo) {
  damage(offsets_[3], 0xff);
  const LogSummary read = split_to(out_);
  EXPECT_EQ(read.damages, 1U);
  EXPECT_EQ(read.damaged_bytes, offsets_[4] - offsets_[3]);
  EXPECT_EQ(read_with_lcm(out_), without(3, 3));
}

TEST_F(LogPieces, MergeIsByTimeAndStable) {
  const auto event = [](const char* name, std::int64_t ms) {
    return TestEvent{name, test_start + 1000 * ms, {1, 2, 3}};
  };
  const path a = folder_.path() / "1.lcmlog", b = folder_.path() / "2.lcmlog";
  record(a, {event("A1", 0), event("A2", 10), event("A3", 10), event("A4", 30)});
  record(b, {event("B1", 0), event("B2", 10), event("B3", 20)});
  const auto order = [&](std::vector<path> logs) {
    EXPECT_EQ(merge(logs, types_, out_, said_).events, 7U);
    std::string names;
    for (const TestEvent& e : read_with_lcm(out_)) names += e.channel + " ";
    return names;
  };
  EXPECT_EQ(order({a, b}), "A1 B1 A2 A3 B2 B3 A4 ");
  EXPECT_EQ(order({b, a}), "B1 A1 B2 A2 A3 B3 A4 ");
}

TEST_F(LogPieces, SplitChannelsMergedAreTheLogAgain) {
  const std::vector<path> parts{folder_.path() / "states.lcmlog.gz",
                                folder_.path() / "others.lcmlog"};
  split_to(parts[0], {.channels = matching("NAV_STATE")});
  split_to(parts[1], {.channels = [](auto channel) { return channel != "NAV_STATE"; }});
  merge(parts, types_, out_, said_);
  EXPECT_EQ(read_with_lcm(out_), drive_);
  EXPECT_EQ(read_bytes(out_), read_bytes(log_));
  EXPECT_THROW(merge(parts, types_, parts[1], said_), std::invalid_argument);
}

TEST_F(LogPieces, MergeOfRealLogsLosesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const path folder = maploop::testing::real_data() / "lcm";
  const std::vector<path> logs{folder / "vlp16_and_wheels.lcm", folder / "vlp16_position.lcm"};
  EXPECT_EQ(merge(logs, types_, out_, said_).events, 172U);
  const auto merged = read_with_lcm(out_);
  ASSERT_EQ(merged.size(), 172U);
  EXPECT_TRUE(std::is_sorted(merged.begin(), merged.end(),
                             [](const auto& a, const auto& b) { return a.time_us < b.time_us; }));
}

}  // namespace
}  // namespace maploop::lcm_log
