// Tests logs as tracks, and matches of a file against the links driven.
#include "tools/match/match_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "msgs/frames.h"
#include "msgs/lcm/conversions.h"
#include "tests/support/real_data.h"
#include "tests/tools/refusal.h"
#include "tools/log/log_writer.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

using maploop::testing::refusal;
using maploop::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr Time start = from_nanoseconds(1'317'042'651'000'000'000);
constexpr Duration tick = std::chrono::milliseconds(10);

class MatchLog : public ::testing::Test {
 protected:
  template <class Lcm>
  void write(std::string_view channel, const Lcm& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    writer.write({.channel = channel, .data = bytes});
  }

  // Writes a GNSS fix, then one second of states to the north, 100 a second.
  void write_states() {
    GnssFix fix;
    fix.stamp = start;
    fix.position = {radians(49.0), radians(8.4), 110.0};
    fix.position_covariance = 4.0 * Eigen::Matrix3d::Identity();
    write("GNSS_FIX", to_lcm(fix));
    for (int i = 0; i < 100; ++i) {
      NavState state;
      state.stamp = state.available = start + i * tick;
      state.status = i < 20 ? NavStatus::uninitialized : NavStatus::aided;
      state.origin = fix.position;
      state.position_enu.y() = 0.1 * i;
      state.forward_speed = 10.0;
      state.covariance.diagonal().setConstant(0.25);
      write("NAV_STATE", to_lcm(state));
    }
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "a.lcmlog";
  schema::Schema types{schema::own_types()};
  lcm_log::LogWriter writer{file, types};
};

TEST_F(MatchLog, ItsStatesAreATrackOfTenFixesASecond) {
  write_states();
  writer.close();
  const Track track = read_track(file, {});
  ASSERT_EQ(track.size(), 8U) << "those with a position";
  EXPECT_EQ(track[0].stamp, start + 20 * tick);
  EXPECT_EQ(track[1].stamp - track[0].stamp, 10 * tick);
  EXPECT_NEAR(degrees(track[0].position.latitude), 49.0 + 2.0 / 111200.0, 1e-7);
  EXPECT_NEAR(track[0].covariance(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(track[0].speed, 10.0, 1e-12);
  EXPECT_NEAR(track[0].speed_sigma, 0.5, 1e-12);
}

TEST_F(MatchLog, VisualOdometryThatWasThereByThenIsInTheFixes) {
  for (int i = 0; i < 9; ++i) {
    RelativeMotion motion;
    motion.status = OdometryStatus::ok;
    motion.from = start + i * 10 * tick;
    motion.stamp = motion.from + 10 * tick;
    motion.available = motion.stamp + 6 * tick;
    motion.translation.x() = 0.9;
    write("VO", to_lcm(motion));
  }
  write_states();
  writer.close();
  const Track track = read_track(file, {});
  ASSERT_EQ(track.size(), 8U);
  EXPECT_NEAR(track[3].visual_speed, 9.0, 1e-12);
  EXPECT_TRUE(std::isnan(track[0].visual_azimuth)) << "the first one";
  EXPECT_EQ(track[3].visual_azimuth, 0.0);
}

TEST_F(MatchLog, WithoutStatesItsFixesAre) {
  GnssFix fix;
  fix.stamp = start;
  fix.position_covariance = 4.0 * Eigen::Matrix3d::Identity();
  write("GNSS_FIX", to_lcm(fix));
  writer.close();
  const Track track = read_track(file, {});
  ASSERT_EQ(track.size(), 1U);
  EXPECT_EQ(track[0].covariance(1, 1), 4.0);
}

TEST_F(MatchLog, ItsMatchesCountAtTheNearestFrames) {
  for (int i = 0; i < 4; ++i) {
    MapMatch match;
    match.stamp = start + i * 10 * tick;
    match.on_road = i != 3;
    match.way_id = i == 1 ? 99 : 10;
    match.probability = 0.95;
    write("MAP_MATCH", to_lcm(match, {}));
  }
  writer.close();
  const auto matches = read_matches(file);
  ASSERT_EQ(matches.size(), 4U);
  const std::vector<Time> frames{start - 2 * tick, start + 11 * tick, start + 19 * tick,
                                 start + 32 * tick, start + 100 * tick};
  std::map<std::size_t, Label> labels;
  for (std::size_t i = 0; i < frames.size(); ++i) labels[i] = {10, 1, 2, i > 0};
  const MatchScore score = score_matches(matches, frames, labels);
  EXPECT_EQ(score.all.fixes, 4U);
  EXPECT_EQ(score.all.right, 2U) << "one is on another way, one on none";
  EXPECT_EQ(score.all.matched, 3U);
  EXPECT_EQ(score.certain.fixes, 3U);
  EXPECT_THAT(to_text(score), HasSubstr("50.00 % of 4 fixes, coverage 75.00 %"));
  EXPECT_EQ(to_json(score)["reliability"][0]["fixes"], 3);
  EXPECT_FALSE(frame_at(start + 60 * tick, frames)) << "too far from any";
}

TEST_F(MatchLog, WhatCannotBeReadIsNamed) {
  write("VO", to_lcm(RelativeMotion{}));
  writer.close();
  EXPECT_THAT(refusal([&] { read_track(file, {}); }), HasSubstr("neither NAV_STATE nor GNSS_FIX"));
  EXPECT_THAT(refusal([&] { read_matches(file); }), HasSubstr("--map"));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  EXPECT_THAT(refusal([&] { read_track(file, {}); }), HasSubstr("damaged"));
}

class MatchCsv : public ::testing::Test {
 protected:
  std::vector<TimedMatch> read(const std::string& text) {
    std::ofstream(file) << text;
    return read_matches(file);
  }
  TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "a.csv";
};

TEST_F(MatchCsv, IdsMayBeEmptyAndColumnsInAnyOrder) {
  const auto matches = read("way_id,t,p_link\n10,1.5,0.75\n,2.5,\n");
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].stamp, Time(from_seconds(1.5)));
  EXPECT_EQ(matches[0].matched.way_id, 10);
  EXPECT_EQ(matches[0].matched.p_link, 0.75);
  EXPECT_FALSE(matches[1].matched.way_id);
  EXPECT_EQ(read("t,way_id\n1,10\n")[0].matched.p_link, 1.0)
      << "of a matcher that is never in doubt";
}

TEST_F(MatchCsv, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(refusal([&] { read(""); }), HasSubstr("empty"));
  EXPECT_THAT(refusal([&] { read("a,b\n"); }), HasSubstr("a.csv:1: no columns t and way_id"));
  EXPECT_THAT(refusal([&] { read("t,way_id,p_link\n1,x,0.5\n"); }), HasSubstr("a.csv:2: 'x'"));
  EXPECT_THAT(refusal([&] { read("t,way_id,p_link\n1,10\n"); }),
              HasSubstr("a.csv:2: a column is missing"));
  EXPECT_THAT(refusal([&] { read("t,way_id,p_link\n1,10,7\n"); }), HasSubstr("from 0 to 1"));
}

}  // namespace
}  // namespace maploop::match
