#include "tools/spy/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <maploop_lcm/health_t.hpp>
#include <maploop_lcm/run_t.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/spy/messages.h"

namespace maploop::spy {
namespace {

using std::chrono::seconds;

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> all;
  for (std::string word; in >> word;) all.push_back(word);
  return all;
}

TEST(SpyText, EveryRowHasTheHeadersColumns) {
  ChannelStatus s;
  s.name = "an evil\x1b[2J name";
  EXPECT_EQ(words(table_row(s)).size(), words(table_header()).size()) << "empty as it is";
  EXPECT_EQ(table_row(s).find('\x1b'), std::string::npos);
  s.type = "maploop_lcm.imu_t";
  s.count = 12;
  s.rate_hz = 9.9;
  s.jitter_s = 0.0021;
  s.age_s = 0.06;
  s.silent_s = 1.5;
  s.bytes = 64;
  s.lost = 3;
  s.bad = 4;
  const std::vector<std::string> expected{"an?evil?[2J?name",
                                          "maploop_lcm.imu_t",
                                          "12",
                                          "9.90",
                                          "2.100",
                                          "0.060",
                                          "1.50",
                                          "64",
                                          "3",
                                          "4"};
  EXPECT_EQ(words(table_row(s)), expected);
  EXPECT_EQ(json_row(s).find('\n'), std::string::npos);
}

TEST(SpyText, TheRunsAreListedAndTwoAreWarnedOf) {
  Traffic traffic(own_schema(), seconds(5));
  const auto say = [&](const char* id, Duration now) {
    maploop_lcm::run_t run{};
    run.id = id;
    run.what = "replay of a drive";
    traffic.add("RUN", encoded(run), now);
  };
  say("0000000b", seconds(1));
  EXPECT_EQ(vehicle_lines(traffic), std::vector<std::string>{"run: 0000000b (replay of a drive)"});
  say("0000000a", seconds(2));
  const auto lines = vehicle_lines(traffic);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "run: 0000000a (replay of a drive)");
  EXPECT_NE(lines[2].find("2 runs publish here"), std::string::npos);
  EXPECT_NE(lines[2].find("--lcm-url"), std::string::npos);
}

TEST(SpyText, FieldsAreValuesAndArraysAreBounded) {
  NavState state;
  state.sequence = 12;
  state.covariance(0, 1) = 0.5;
  const auto lines = field_lines(own_schema(), encoded(to_lcm(state)));
  const auto has = [&](const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  EXPECT_TRUE(has("header.sequence = 12"));
  EXPECT_TRUE(has("position_enu[3] = 0 0 0"));
  EXPECT_TRUE(has("covariance[9][9] = 0 0.5 0 0 0 0 0 0 ..."));
}

TEST(SpyText, FieldsOfStructsStringsAndEmptyArrays) {
  Health health;
  health.threads = {{"fusion", "fifo 60", 1480, 100.0, ""}};
  health.degraded = {"too\x1b[2J slow"};
  const auto lines = field_lines(own_schema(), encoded(to_lcm(health)));
  const auto has = [&](const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  EXPECT_TRUE(has("threads[0].name = \"fusion\""));
  EXPECT_TRUE(has("threads[0].count = 1480"));
  EXPECT_TRUE(has("rings[0] ="));
  EXPECT_TRUE(has("degraded[0] = \"too\\x1b[2J slow\"")) << "nothing that a terminal obeys";
}

TEST(SpyText, AMessageThatIsNoneSaysWhy) {
  EXPECT_NE(field_lines(own_schema(), {}).at(0).find("--types"), std::string::npos);
  auto cut = imu(1, {});
  cut.resize(20);
  EXPECT_NE(field_lines(own_schema(), cut).at(0).find("at byte"), std::string::npos);
}

TEST(SpyText, AMessageWithoutMeaningMakesNoLine) {
  Traffic traffic(own_schema(), seconds(5));
  maploop_lcm::health_t health{};
  health.utime = std::numeric_limits<std::int64_t>::max();  // a stamp cannot represent it
  traffic.add("HEALTH", encoded(health), seconds(1));
  EXPECT_TRUE(vehicle_lines(traffic).empty());
}

TEST(SpyText, RingsDeadlinesAndDegradedModesInALineEach) {
  Traffic traffic(own_schema(), seconds(5));
  EXPECT_TRUE(vehicle_lines(traffic).empty());
  Health health;
  health.rings = {{"imu -> fusion", 10, 8, 1, 1, 256}, {"camera -> stereo", 10, 7, 0, 3, 4}};
  health.degraded = {"the clock was stalled"};
  Deadlines deadlines;
  deadlines.threads = {{.name = "fusion", .count = 100, .misses = 2, .guilty = "woken late"}};
  traffic.add("HEALTH", encoded(to_lcm(health)), seconds(1));
  traffic.add("DEADLINES", encoded(to_lcm(deadlines)), seconds(1));
  PppState ppp;
  ppp.status = PppStatus::converged;
  ppp.satellites_used = 1;
  ppp.satellites.resize(2);
  ppp.protection = {0.1, 0.2, 0.3};
  ppp.integrity_risk = 1e-4;
  traffic.add("PPP_STATE", encoded(to_lcm(ppp)), seconds(1));
  NavProtection levels;
  levels.risk = 1e-4;
  levels.along = 4.0;
  levels.across = 3.0;
  levels.horizontal = 5.25;
  traffic.add("NAV_PROTECTION", encoded(to_lcm(levels)), seconds(1));
  const auto lines = vehicle_lines(traffic);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[3], "position: within 5.25 m, 4.00 along, 3.00 across but for a risk of 0.0001");
  EXPECT_EQ(
      lines[4],
      "ppp: converged, 1 of 2 satellites, within 0.10 m along, 0.20 across, 0.30 up but for a "
      "risk of 0.0001");
  EXPECT_EQ(lines[0], "rings: 2, lost 1, fullest camera -> stereo 3 of 4");
  EXPECT_EQ(lines[1], "degraded: 1: the clock was stalled");
  EXPECT_EQ(lines[2], "deadlines: fusion missed 2 of 100 (worst 0.0 of 0 ms: woken late)");
  traffic.add("HEALTH", imu(0, {}), seconds(1));
  EXPECT_EQ(vehicle_lines(traffic).size(), 3u) << "another type on its channel";
}

}  // namespace
}  // namespace maploop::spy
