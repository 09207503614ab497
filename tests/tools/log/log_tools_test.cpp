// Tests `log info`, `log verify` and `log recover`; recovered logs are read back by LCM itself.
#include "tools/log/log_tools.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/log/log_header.h"
#include "tests/tools/log/small_log.h"

namespace maploop::lcm_log {
namespace {

class LogTools : public LogToolsTest {
 protected:
  std::string table(const path& json = {}) const {
    std::ostringstream out;
    info(log_, types_, json, out);
    return out.str();
  }

  Verification verified(const path& log, const schema::Schema& types) {
    said_.str("");
    return verify(log, types, said_);
  }
  Verification verified() { return verified(log_, types_); }

  Recovery recovered() {
    said_.str("");
    return recover(log_, types_, out_, said_);
  }

  bool says(const std::string& text) const { return contains(said_.str(), text); }

  std::ostringstream said_;  // of the last verified() or recovered()
};

TEST_F(LogTools, InfoOfAChannelByHand) {
  std::vector<TestEvent> events;
  for (const std::int64_t ms : {0, 100, 210, 300, 400, 800, 900}) {
    events.push_back({"NAV_STATE", test_start + 1000 * ms, nav_state_bytes(0.0)});
  }
  events.push_back({"RAW", test_start + 900'000, unknown_bytes(20, 1)});
  record(log_, events);
  const std::string text = table(out_);
  const auto all = nlohmann::json::parse(std::ifstream(out_));
  EXPECT_EQ(all["events"], 8);
  EXPECT_EQ(all["first_us"], test_start);
  EXPECT_EQ(all["last_us"], test_start + 900'000);
  const auto& c = all["channels"]["NAV_STATE"];
  EXPECT_EQ(c["count"], 7);
  EXPECT_EQ(c["bytes"], 7 * nav_state_bytes(0.0).size());
  ASSERT_EQ(c["types"].size(), 1U);
  EXPECT_EQ(c["types"][0]["name"], "maploop_lcm.nav_state_t");
  EXPECT_NEAR(c["rate_hz"], 6 / 0.9, 1e-9);
  // Intervals of 90, 100, 100, 100, 110 and 400 ms: mean 150, squared deviations 75,200.
  EXPECT_NEAR(c["interval_median_s"], 0.1, 0.0008);
  EXPECT_NEAR(c["interval_jitter_s"], std::sqrt(75'200.0 / 5) * 1e-3, 1e-9);
  EXPECT_NEAR(c["interval_longest_s"], 0.4, 1e-9);
  EXPECT_EQ(c["interval_longest_from_us"], test_start + 400'000);
  EXPECT_EQ(c["gaps"], 1);
  EXPECT_TRUE(all["channels"]["RAW"]["types"][0]["name"].is_null());
  EXPECT_EQ(all["channels"]["RAW"]["rate_hz"], 0.0);
  for (const char* part : {"8 events", "maploop_lcm.nav_state_t", "2011-09-26 13:10:51",
                           "longest gap 0.400 s", "0x05529fec3986d320"}) {
    EXPECT_TRUE(contains(text, part)) << part << '\n' << text;
  }
  EXPECT_TRUE(
      contains(error_of<std::runtime_error>([&] { table("/nowhere/a.json"); }), "/nowhere/a.json"));
}

TEST_F(LogTools, InfoOfWhatIsNoLog) {
  write_bytes(log_, {'h', 'e', 'l', 'l', 'o'});
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { table(); }), "is it an LCM log?"));
  write_bytes(log_, {});
  EXPECT_TRUE(contains(table(), "an empty log"));
}

TEST_F(LogTools, TimesBeyondReason) {
  auto bytes = read_bytes(log_);
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  for (const auto& [event, time] : {std::pair{0U, most}, {3U, -most}}) {
    const LogHeader header = read_header(std::span(bytes).subspan(offsets_[event]));
    LogHeader changed = header;
    changed.time_us = time;
    write_header(changed, std::span<std::uint8_t, header_bytes>(bytes.data() + offsets_[event],
                                                                header_bytes));
  }
  write_bytes(log_, bytes);
  EXPECT_TRUE(contains(table(), "9223372036854775807 us"));
  EXPECT_GT(verified().findings, 0U);
}

TEST(LogText, SizesAndTimes) {
  EXPECT_EQ(size_text(999), "999 B");
  EXPECT_EQ(size_text(1'410'107), "1.4 MB");
  EXPECT_EQ(size_text(999'999), "1.0 MB");
  EXPECT_EQ(time_text(test_start + 5), "2011-09-26 13:10:51.000005");
  EXPECT_EQ(time_text(-1), "-1 us");
}

TEST_F(LogTools, VerifyFindsNothingInASoundLog) {
  const Verification v = verified();
  EXPECT_EQ(v.findings, 0U) << said_.str();
  EXPECT_EQ(v.events, 24U);
  EXPECT_EQ(v.decoded, 19U);
  EXPECT_EQ(v.unknown, 5U);  // CAMERA_TRIGGER, and one message without data
}

TEST_F(LogTools, VerifyNamesOffsetEventAndReason) {
  const std::size_t name_length = offsets_[7] + header_bytes + 6 + 8 + 8 + 4;  // threads[0].name
  const auto byte = [&](std::size_t event) { return "byte " + std::to_string(offsets_[event]); };
  const std::vector<std::tuple<std::size_t, std::uint8_t, std::string>> cases{
      {offsets_[3], 0x01, byte(3) + ": 902 bytes are not an event"},
      {offsets_[3] + 11, 0x40, byte(3) + ", event 67: its number follows 2"},
      {offsets_[3] + 15, 0x01, byte(3) + ", event 3: time of NAV_STATE goes back by 4294."},
      {name_length, 0x80, byte(7) + ", event 7: HEALTH does not decode as maploop_lcm.health_t: "}};
  for (const auto& [offset, mask, text] : cases) {
    damage(offset, mask);
    EXPECT_GE(verified().findings, 1U) << text;
    EXPECT_TRUE(says(text)) << text << '\n' << said_.str();
    damage(offset, mask);  // undamaged again
  }
}

TEST_F(LogTools, VerifyAllowsThreadsToDifferButNotWithinAChannel) {
  const auto state = nav_state_bytes(0.0);
  record(log_, {{"A", test_start + 1000, state}, {"B", test_start, state}});
  EXPECT_EQ(verified().findings, 0U);
  record(log_, {{"A", test_start + 1000, state}, {"A", test_start, state}});
  EXPECT_EQ(verified().findings, 1U);
  EXPECT_TRUE(says(", event 1: time of A goes back by 0.001000 s")) << said_.str();
}

TEST_F(LogTools, VerifyCountsMoreFindingsThanItPrints) {
  std::vector<TestEvent> events;
  for (int i = 0; i < 1003; ++i) events.push_back({"A", test_start - i, {}});
  record(log_, events);
  EXPECT_EQ(verified().findings, 1002U);
  EXPECT_TRUE(says("... 2 more\n"));
}

TEST_F(LogTools, ThirdPartyLogsDecodeByTheirOwnType) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const path folder = maploop::testing::real_data() / "lcm";
  const std::vector<path> files{folder / "idsc.lcm"};
  const auto with_theirs = load_types(files);
  for (const auto& [name, count] :
       {std::pair{"vlp16_and_wheels.lcm", 161U}, {"vlp16_position.lcm", 11U}}) {
    const Verification v = verified(folder / name, with_theirs);
    EXPECT_EQ(v.findings, 0U) << said_.str();
    EXPECT_EQ(v.decoded, count);
    EXPECT_EQ(verified(folder / name, types_).unknown, count);
  }
}

TEST_F(LogTools, TypesThatCannotBeReadAreNamedWithFileAndLine) {
  std::ofstream(out_) << "struct bad_t\n{\n  int x;\n}\n";
  const std::vector<path> bad{out_}, missing{folder_.path() / "missing.lcm"};
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { load_types(bad); }), "out.lcmlog:3: "));
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { load_types(missing); }), "missing.lcm"));
}

TEST_F(LogTools, RecoverSaysWhatWasLost) {
  auto bytes = read_bytes(log_);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[3]),
            bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[5]) + 10, std::uint8_t{0});
  bytes.erase(bytes.end() - 5, bytes.end());
  write_bytes(log_, bytes);
  const Recovery r = recovered();
  EXPECT_EQ(r.losses, 2U);
  EXPECT_EQ(r.lost_events, 3U);
  EXPECT_EQ(r.lost_bytes, offsets_[6] - offsets_[3] + bytes.size() - offsets_[23]);
  EXPECT_TRUE(says("lost bytes " + std::to_string(offsets_[3]) + " to " +
                   std::to_string(offsets_[6]) +
                   ", events 3 to 5, between 2011-09-26 13:10:51.020000 and 2011-09-26 "
                   "13:10:51.060000 (0.040000 s): "))
      << said_.str();
  EXPECT_TRUE(says("lost bytes " + std::to_string(offsets_[23]) + " to ")) << said_.str();
  EXPECT_TRUE(says(", after 2011-09-26 13:10:51.220000: ")) << said_.str();
  auto expected = without(3, 5);
  expected.pop_back();
  EXPECT_EQ(read_with_lcm(out_), expected);
  EXPECT_EQ(verified(out_, types_).findings, 0U);
}

TEST_F(LogTools, RecoverOfASoundLogIsTheLog) {
  EXPECT_EQ(recovered().losses, 0U);
  EXPECT_EQ(read_bytes(out_), read_bytes(log_));
}

TEST_F(LogTools, RecoverLeavesOutWhatDoesNotDecode) {
  damage(offsets_[7] + header_bytes + 6 + 8 + 8, 0x40);  // a million more threads
  const Recovery r = recovered();
  EXPECT_EQ(r.losses, 1U);
  EXPECT_EQ(r.lost_events, 1U);
  EXPECT_TRUE(says(", event 7, between ")) << said_.str();
  EXPECT_TRUE(says("HEALTH does not decode")) << said_.str();
  EXPECT_EQ(read_with_lcm(out_).size(), 23U);
}

TEST_F(LogTools, RecoverOfWhatHoldsNoEventWritesNothing) {
  write_bytes(log_, std::vector<std::uint8_t>(1000, 0x55));
  EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { recovered(); }), "no readable event"));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_THROW(recover(log_, types_, log_, said_), std::invalid_argument);
}

TEST_F(LogTools, RecoverCountsWithNumbersThatAreFarApart) {
  damage(offsets_[3], 0xff);      // not an event any more: a loss
  damage(offsets_[4] + 4, 0x7f);  // the number of the event after it
  damage(offsets_[2] + 4, 0x80);  // the number of the event before it
  EXPECT_EQ(recovered().events, drive_.size() - 1);
}

TEST_F(LogTools, RecoveredLogsAreSoundWhateverWasDamaged) {
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
    const Recovery r = recovered();
    ASSERT_EQ(verified(out_, types_).findings, 0U);
    ASSERT_EQ(read_with_lcm(out_).size(), r.events);
    ASSERT_GE(r.events, drive_.size() - 6);
  }
}

}  // namespace
}  // namespace maploop::lcm_log
