// Tests `log verify` with our own types and those of others.
#include "tools/log/log_verify.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/log/log_header.h"
#include "tests/tools/log/log_tools_fixture.h"

namespace maploop::lcm_log {
namespace {

TEST_F(LogToolsTest, VerifyFindsNothingInASoundLog) {
  const Verification v = verify(log_, types());
  EXPECT_EQ(v.finding_count, 0U) << format_findings(v);
  EXPECT_EQ(v.events, 24U);
  EXPECT_EQ(v.decoded + v.unknown, 24U);
  EXPECT_EQ(v.unknown, 5U);  // CAMERA_TRIGGER, and one message without data
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

}  // namespace
}  // namespace maploop::lcm_log
