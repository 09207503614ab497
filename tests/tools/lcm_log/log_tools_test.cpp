// What the log tools answer and write; what they write is read back by LCM itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "tests/support/real_data.h"
#include "tests/tools/lcm_log/small_log.h"
#include "tools/lcm_log/log_diff.h"
#include "tools/lcm_log/log_header.h"
#include "tools/lcm_log/log_info.h"
#include "tools/lcm_log/log_merge.h"
#include "tools/lcm_log/log_recover.h"
#include "tools/lcm_log/log_split.h"
#include "tools/lcm_log/log_text.h"
#include "tools/lcm_log/log_types.h"
#include "tools/lcm_log/log_verify.h"

namespace maploop::lcm_log {
namespace {

using std::filesystem::path;

const schema::Schema& types() {
  static const schema::Schema schema = load_types({});
  return schema;
}

template <class Error, class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class LogToolsTest : public ::testing::Test {
 protected:
  LogToolsTest() { record(log_, drive_); }

  void damage(std::size_t offset, std::uint8_t mask) {
    auto bytes = read_bytes(log_);
    bytes[offset] ^= mask;
    write_bytes(log_, bytes);
  }

  const maploop::testing::TemporaryFolder folder_;
  const path log_ = folder_.path() / "a.lcmlog";
  const path out_ = folder_.path() / "out.lcmlog";
  const std::vector<TestEvent> drive_ = small_drive();
  const std::vector<std::size_t> offsets_ = event_offsets(drive_);
};

// ---- info

const ChannelInfo& channel(const LogInfo& info, const std::string& name) {
  return *std::find_if(info.channels.begin(), info.channels.end(),
                       [&](const ChannelInfo& c) { return c.name == name; });
}

TEST_F(LogToolsTest, InfoOfAChannelByHand) {
  std::vector<TestEvent> events;
  for (const std::int64_t ms : {0, 100, 210, 300, 400, 800, 900}) {
    events.push_back({"NAV_STATE", kTestStart + 1000 * ms, nav_state_bytes(0.0)});
  }
  events.push_back({"RAW", kTestStart + 900'000, unknown_bytes(20, 1)});
  record(log_, events);
  const LogInfo info = read_info(log_, types());
  EXPECT_EQ(info.events, 8U);
  EXPECT_EQ(info.first_us, kTestStart);
  EXPECT_EQ(info.last_us, kTestStart + 900'000);
  const ChannelInfo& c = channel(info, "NAV_STATE");
  EXPECT_EQ(c.count, 7U);
  EXPECT_EQ(c.bytes, 7 * nav_state_bytes(0.0).size());
  ASSERT_EQ(c.types.size(), 1U);
  EXPECT_EQ(c.types[0].name, "maploop_lcm.nav_state_t");
  EXPECT_NEAR(c.rate_hz, 6 / 0.9, 1e-9);
  // Intervals of 90, 100, 100, 100, 110 and 400 ms: mean 150, squared deviations 75,200.
  EXPECT_NEAR(c.median_s, 0.1, 0.0008);
  EXPECT_NEAR(c.jitter_s, std::sqrt(75'200.0 / 5) * 1e-3, 1e-9);
  EXPECT_NEAR(c.longest_s, 0.4, 1e-9);
  EXPECT_EQ(c.longest_from_us, kTestStart + 400'000);
  EXPECT_EQ(c.gaps, 1U);
  EXPECT_EQ(channel(info, "RAW").types[0].name, "");
  EXPECT_EQ(channel(info, "RAW").rate_hz, 0.0);
}

TEST_F(LogToolsTest, InfoAsTableAndAsJson) {
  const LogInfo info = read_info(log_, types());
  const std::string table = format_table(info);
  for (const char* part :
       {"24 events", "maploop_lcm.imu_t", "2011-09-26 13:10:51", "0x05529fec3986d320"}) {
    EXPECT_TRUE(contains(table, part)) << part << '\n' << table;
  }
  const path file = folder_.path() / "info.json";
  write_json(file, info);
  const auto json = nlohmann::json::parse(std::ifstream(file));
  EXPECT_EQ(json["events"], 24);
  EXPECT_EQ(json["channels"]["NAV_STATE"]["count"], 8);
  EXPECT_EQ(json["channels"]["NAV_STATE"]["types"][0]["name"], "maploop_lcm.nav_state_t");
  EXPECT_TRUE(json["channels"]["CAMERA_TRIGGER"]["types"][0]["name"].is_null());
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { write_json("/nowhere/a.json", info); }),
                       "/nowhere/a.json"));
}

TEST_F(LogToolsTest, InfoOfWhatIsNoLog) {
  write_bytes(log_, {'h', 'e', 'l', 'l', 'o'});
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { read_info(log_, types()); }),
                       "is it an LCM log?"));
  write_bytes(log_, {});
  EXPECT_TRUE(contains(format_table(read_info(log_, types())), "an empty log"));
}

TEST_F(LogToolsTest, InfoOfTimesBeyondReason) {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  auto bytes = read_bytes(log_);
  const std::uint64_t times[] = {static_cast<std::uint64_t>(kMost),
                                 static_cast<std::uint64_t>(-kMost)};
  for (std::size_t event = 0; event < 2; ++event) {
    for (std::size_t i = 0; i < 8; ++i) {
      bytes[offsets_[event] + 12 + i] = static_cast<std::uint8_t>(times[event] >> (56 - 8 * i));
    }
  }
  write_bytes(log_, bytes);
  EXPECT_TRUE(contains(format_table(read_info(log_, types())), "9223372036854775807 us"));
  EXPECT_GT(verify(log_, types()).finding_count, 0U);
}

// ---- verify

TEST_F(LogToolsTest, VerifyFindsNothingInASoundLog) {
  const Verification v = verify(log_, types());
  EXPECT_EQ(v.finding_count, 0U) << format_findings(v);
  EXPECT_EQ(v.events, 24U);
  EXPECT_EQ(v.decoded + v.unknown, 24U);
  EXPECT_EQ(v.unknown, 5U);  // CAMERA_TRIGGER, and one without data
}

TEST_F(LogToolsTest, VerifyNamesOffsetEventAndReason) {
  struct Case {
    std::size_t offset;
    std::uint8_t mask;
    std::size_t finding_offset;
    std::string reason;
  };
  const std::size_t name_length = offsets_[7] + kHeaderBytes + 6 + 8 + 8 + 4;  // threads[0].name
  const std::vector<Case> cases{
      {offsets_[3], 0x01, offsets_[3], "bytes are no event"},
      {offsets_[3] + 11, 0x40, offsets_[3], "its number follows 2"},
      {offsets_[3] + 15, 0x01, offsets_[3], "time goes back by 4294."},
      {name_length, 0x80, offsets_[7], "HEALTH does not decode as maploop_lcm.health_t"}};
  const auto whole = read_bytes(log_);
  for (const Case& c : cases) {
    write_bytes(log_, whole);
    damage(c.offset, c.mask);
    const Verification v = verify(log_, types());
    ASSERT_GE(v.finding_count, 1U) << c.reason;
    EXPECT_EQ(v.findings[0].offset, c.finding_offset) << c.reason;
    EXPECT_TRUE(contains(v.findings[0].reason, c.reason)) << v.findings[0].reason;
    EXPECT_TRUE(contains(format_findings(v), "byte " + std::to_string(c.finding_offset)));
  }
}

TEST_F(LogToolsTest, VerifyAllowsThreadsToDifferALittleButNotWithinAChannel) {
  const auto state = nav_state_bytes(0.0);
  record(log_, {{"A", kTestStart + 1000, state}, {"B", kTestStart, state}});
  EXPECT_EQ(verify(log_, types()).finding_count, 0U);
  EXPECT_EQ(verify(log_, types()).disorders, 1U);
  record(log_, {{"A", kTestStart + 1000, state}, {"A", kTestStart, state}});
  const Verification v = verify(log_, types());
  ASSERT_EQ(v.finding_count, 1U);
  EXPECT_EQ(v.findings[0].reason, "time of A goes back by 0.001000 s");
  EXPECT_EQ(v.findings[0].event, 1);
}

TEST_F(LogToolsTest, VerifyCountsMoreFindingsThanItLists) {
  auto bytes = read_bytes(log_);
  bytes.pop_back();
  write_bytes(log_, bytes);
  const Verification v = verify(log_, types(), {.max_disorder_s = 1.0, .max_listed = 0});
  EXPECT_EQ(v.finding_count, 1U);
  EXPECT_TRUE(contains(format_findings(v), "... 1 more"));
}

TEST_F(LogToolsTest, ThirdPartyLogsDecodeByTheirOwnType) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const path folder = maploop::testing::real_data() / "lcm";
  const std::vector<path> files{folder / "idsc.lcm"};
  const auto schema = load_types(files);
  for (const auto& [name, count] :
       {std::pair{"vlp16_and_wheels.lcm", 161U}, {"vlp16_position.lcm", 11U}}) {
    const Verification v = verify(folder / name, schema);
    EXPECT_EQ(v.finding_count, 0U) << format_findings(v);
    EXPECT_EQ(v.decoded, count);
    EXPECT_EQ(verify(folder / name, types()).unknown, count);
  }
}

TEST(LoadTypes, NamesTheFileAndLineThatIsWrong) {
  const maploop::testing::TemporaryFolder folder;
  const path file = folder.path() / "bad_t.lcm";
  std::ofstream(file) << "struct bad_t\n{\n  int x;\n}\n";
  const std::vector<path> bad{file}, missing{folder.path() / "missing.lcm"};
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { load_types(bad); }), "bad_t.lcm:3: "));
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { load_types(missing); }), "missing.lcm"));
}

// ---- split

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
                       "choose another -o"));
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

// ---- merge

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

// ---- recover

TEST_F(LogToolsTest, RecoverSaysWhatWasLost) {
  auto bytes = read_bytes(log_);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[4]),
            bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[6]) + 10, std::uint8_t{0});
  bytes.erase(bytes.end() - 5, bytes.end());
  write_bytes(log_, bytes);
  const Recovery r = recover(log_, types(), out_);
  ASSERT_EQ(r.loss_count, 2U) << format_report(r);
  EXPECT_EQ(r.losses[0].begin, offsets_[4]);
  EXPECT_EQ(r.losses[0].end, offsets_[7]);
  EXPECT_EQ(r.losses[0].first_event, 4);
  EXPECT_EQ(r.losses[0].last_event, 6);
  EXPECT_EQ(r.losses[0].after_us, drive_[3].time_us);
  EXPECT_EQ(r.losses[0].before_us, drive_[7].time_us);
  EXPECT_TRUE(contains(r.losses[0].reason, "event 3 before it is kept")) << r.losses[0].reason;
  EXPECT_EQ(r.losses[1].begin, offsets_[23]);
  EXPECT_FALSE(r.losses[1].before_us);
  EXPECT_EQ(r.lost_events, 3U);
  EXPECT_TRUE(contains(format_report(r), "events 4 to 6")) << format_report(r);

  auto expected = drive_;
  expected.pop_back();
  expected.erase(expected.begin() + 4, expected.begin() + 7);
  EXPECT_EQ(read_with_lcm(out_), expected);
  EXPECT_EQ(verify(out_, types()).finding_count, 0U);
}

TEST_F(LogToolsTest, RecoverOfASoundLogIsTheLog) {
  const Recovery r = recover(log_, types(), out_);
  EXPECT_EQ(r.loss_count, 0U);
  EXPECT_EQ(r.repair_count, 0U);
  EXPECT_EQ(read_bytes(out_), read_bytes(log_));
}

TEST_F(LogToolsTest, RecoverRepairsTimesThatItsNeighboursContradict) {
  const auto whole = read_bytes(log_);
  for (const std::size_t event : {0U, 1U, 11U, 22U}) {
    write_bytes(log_, whole);
    damage(offsets_[event] + 13, 0x10);  // nine years
    const Recovery r = recover(log_, types(), out_);
    EXPECT_EQ(r.repair_count, 1U) << event;
    EXPECT_TRUE(contains(format_report(r), "repaired"));
    EXPECT_EQ(verify(out_, types()).finding_count, 0U) << event;
    const auto events = read_with_lcm(out_);
    ASSERT_EQ(events.size(), drive_.size());
    EXPECT_NEAR(static_cast<double>(events[event].time_us),
                static_cast<double>(drive_[event].time_us), 10'001.0);
    EXPECT_EQ(events[event].data, drive_[event].data);
  }
}

TEST_F(LogToolsTest, RecoverKeepsARealPause) {
  auto events = drive_;
  for (std::size_t i = 12; i < events.size(); ++i) events[i].time_us += 86'400'000'000;
  record(log_, events);
  EXPECT_EQ(recover(log_, types(), out_).repair_count, 0U);
  EXPECT_EQ(read_with_lcm(out_), events);
}

TEST_F(LogToolsTest, RecoverLeavesOutWhatDoesNotDecode) {
  damage(offsets_[7] + kHeaderBytes + 6 + 8 + 8, 0x40);  // a million more threads
  const Recovery r = recover(log_, types(), out_);
  ASSERT_EQ(r.loss_count, 1U);
  EXPECT_EQ(r.losses[0].first_event, 7);
  EXPECT_TRUE(contains(r.losses[0].reason, "HEALTH does not decode"));
  EXPECT_EQ(r.lost_events, 1U);
  EXPECT_EQ(read_with_lcm(out_).size(), 23U);
}

TEST_F(LogToolsTest, RecoverOfWhatHoldsNoEventWritesNothing) {
  write_bytes(log_, std::vector<std::uint8_t>(1000, 0x55));
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { recover(log_, types(), out_); }),
                       "no readable event"));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_THROW(recover(log_, types(), log_), std::invalid_argument);
}

TEST_F(LogToolsTest, RecoveredLogsAreSoundWhateverWasDamaged) {
  const auto whole = read_bytes(log_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 300; ++round) {
    auto bytes = whole;
    for (auto n = 1 + random() % 6; n > 0; --n) {
      const std::size_t event = random() % drive_.size();
      const std::size_t field = random() % 2 == 0 ? random() % 4 : 20 + random() % 8;
      bytes[offsets_[event] + field] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    write_bytes(log_, bytes);
    const Recovery r = recover(log_, types(), out_);
    ASSERT_EQ(verify(out_, types()).finding_count, 0U);
    ASSERT_EQ(read_with_lcm(out_).size(), r.events);
    ASSERT_GE(r.events, drive_.size() - 6);
  }
}

// ---- diff

class LogDiffTest : public LogToolsTest {
 protected:
  LogDiff compare_with(const std::vector<TestEvent>& events, ChannelFilter filter = {}) {
    record(other_, events);
    return diff(log_, other_, types(), std::move(filter));
  }

  static const ChannelDiff& channel(const LogDiff& diff, const std::string& name) {
    return *std::find_if(diff.channels.begin(), diff.channels.end(),
                         [&](const ChannelDiff& c) { return c.channel == name; });
  }

  const path other_ = folder_.path() / "b.lcmlog";
};

TEST_F(LogDiffTest, SameMessagesAtOtherTimesInAnotherOrderOfChannelsAreTheSame) {
  auto events = drive_;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.channel < b.channel; });
  for (TestEvent& e : events) e.time_us += 5;
  const LogDiff result = compare_with(events);
  EXPECT_TRUE(result.same());
  EXPECT_EQ(result.channels.size(), 5U);
}

TEST_F(LogDiffTest, NamesFirstDifferingMessageAndField) {
  auto events = drive_;
  events[9].data = nav_state_bytes(1.25);
  events[12].data = nav_state_bytes(1.25);
  const LogDiff result = compare_with(events);
  EXPECT_FALSE(result.same());
  const ChannelDiff& c = channel(result, "NAV_STATE");
  EXPECT_EQ(c.number, 3U);  // events 0, 3, 6, 9
  EXPECT_EQ(c.differing, 2U);
  EXPECT_EQ(c.time_a_us, drive_[9].time_us);
  ASSERT_TRUE(c.field);
  EXPECT_EQ(c.field->field, "position_enu[0]");
  EXPECT_EQ(c.field->a, "0.9");
  EXPECT_EQ(c.field->b, "1.25");
  EXPECT_TRUE(channel(result, "IMU").same());
  EXPECT_TRUE(contains(format_diff(result, "a", "b"), "message 3, position_enu[0]"));
}

TEST_F(LogDiffTest, MissingMessagesAndChannels) {
  auto events = drive_;
  events.pop_back();  // the last of X
  std::erase_if(events, [](const auto& e) { return e.channel == "IMU"; });
  events.push_back({"NEW", kTestStart, {1}});
  const LogDiff result = compare_with(events);
  EXPECT_EQ(channel(result, "X").number, 3U);
  EXPECT_EQ(channel(result, "X").time_a_us, drive_[23].time_us);
  EXPECT_FALSE(channel(result, "X").time_b_us);
  EXPECT_EQ(channel(result, "IMU").number, 0U);
  EXPECT_EQ(channel(result, "NEW").count_a, 0U);
  EXPECT_FALSE(channel(result, "NEW").same());
  EXPECT_TRUE(contains(format_diff(result, "a", "b"), "has no such message"));
}

TEST_F(LogDiffTest, OnlyTheChosenChannelsCount) {
  auto events = drive_;
  events[9].data = nav_state_bytes(1.25);
  EXPECT_TRUE(compare_with(events, ChannelFilter("IMU|X")).same());
}

TEST_F(LogDiffTest, DamagedLogCannotBeCompared) {
  record(other_, drive_);
  damage(offsets_[3], 0xff);
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { diff(log_, other_, types(), {}); }),
                       "is damaged at byte " + std::to_string(offsets_[3])));
}

TEST(FieldDifference, OddCases) {
  const auto difference = [](const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b) {
    const auto d = compare(a, b, types());
    return d ? d->field + ": " + d->a + " | " + d->b : "same";
  };
  EXPECT_EQ(difference({}, {}), "same");
  EXPECT_EQ(difference({}, {1}), "byte 0: nothing: 0 bytes in all | 0x01");
  EXPECT_EQ(difference(unknown_bytes(20, 1), unknown_bytes(20, 2)), "byte 8: 0x01 | 0x02");
  EXPECT_EQ(difference(unknown_bytes(20, 1), nav_state_bytes(0.0)),
            "type: unknown type 0x05529fec3986d320 | maploop_lcm.nav_state_t");
  EXPECT_EQ(difference(health_bytes(1), health_bytes(2)), "thread_count: 1 | 2");
  EXPECT_EQ(difference(nav_state_bytes(0.0), nav_state_bytes(-0.0)), "position_enu[0]: 0 | -0");
  auto cut = nav_state_bytes(0.0);
  cut.resize(100);
  EXPECT_EQ(difference(cut, nav_state_bytes(0.0)), "byte 100: nothing: 100 bytes in all | 0x00");
}

TEST(FieldDifference, NansShowTheirBits) {
  const auto a = nav_state_bytes(std::numeric_limits<double>::quiet_NaN());
  auto b = a;
  const auto at = std::mismatch(a.begin(), a.end(), nav_state_bytes(0.0).begin()).first - a.begin();
  b[static_cast<std::size_t>(at) + 7] ^= 1;
  const auto d = compare(a, b, types());
  ASSERT_TRUE(d);
  EXPECT_EQ(d->field, "position_enu[0]");
  EXPECT_EQ(d->a, "nan (0x7ff8000000000000)");
  EXPECT_EQ(d->b, "nan (0x7ff8000000000001)");
}

TEST(LogText, SizesAndTimes) {
  EXPECT_EQ(size_text(999), "999 B");
  EXPECT_EQ(size_text(1'410'107), "1.4 MB");
  EXPECT_EQ(size_text(999'999), "1.0 MB");
  EXPECT_EQ(time_text(kTestStart + 5), "2011-09-26 13:10:51.000005");
  EXPECT_EQ(time_text(-1), "-1 us");
}

}  // namespace
}  // namespace maploop::lcm_log
