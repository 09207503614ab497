// Tests `log info`.
#include "tools/log/log_info.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "msgs/lcm/log/log_header.h"
#include "tests/tools/log/log_tools_fixture.h"
#include "tools/log/log_text.h"
#include "tools/log/log_verify.h"

namespace maploop::lcm_log {
namespace {

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

TEST(LogText, SizesAndTimes) {
  EXPECT_EQ(size_text(999), "999 B");
  EXPECT_EQ(size_text(1'410'107), "1.4 MB");
  EXPECT_EQ(size_text(999'999), "1.0 MB");
  EXPECT_EQ(time_text(kTestStart + 5), "2011-09-26 13:10:51.000005");
  EXPECT_EQ(time_text(-1), "-1 us");
}

}  // namespace
}  // namespace maploop::lcm_log
