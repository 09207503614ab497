// Tests the score of a fused state against a reference whose accuracy changes.
#include "tools/replay/fusion_score.h"
#include "tools/replay/outage_score.h"
#include "tools/replay/protection_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace maploop::fusion_score {
namespace {

using std::chrono::milliseconds;

const Time start = parse_time("2011-09-30 13:00:00");
const LocalFrame frame(Geodetic{0.855, 0.147, 110.0});

// A reference that moves north at 10 m/s for 20 s; the stated accuracy is `accuracy` in the first
// half and 0.1 m in the second.
std::vector<ReferencePose> reference(double accuracy) {
  std::vector<ReferencePose> rows(201);
  for (int i = 0; i <= 200; ++i) {
    ReferencePose& row = rows[static_cast<std::size_t>(i)];
    row.stamp = start + milliseconds(100 * i);
    row.position = frame.to_geodetic({0.0, 1.0 * i, 0.0});
    row.position_accuracy = i < 100 ? accuracy : 0.1;
  }
  return rows;
}

// Returns a track 5 m east of the reference in the first half, 1 m in the second.
NavTrack track() {
  NavTrack track;
  for (int i = 0; i <= 2000; ++i) {
    NavState s;
    s.stamp = start + milliseconds(10 * i);
    s.sequence = static_cast<std::uint64_t>(i);
    s.status = NavStatus::aided;
    s.origin = frame.origin();
    s.position_enu = {i < 1000 ? 5.0 : 1.0, 0.1 * i, 0.0};
    s.covariance.setIdentity();
    track.add(s);
  }
  return track;
}

// The track stands still in its velocities, so that along is east.
TEST(ProtectionScore, CountsErrorsBeyondTheLevelsThatHold) {
  std::vector<NavProtection> levels;
  for (int i = 0; i <= 2000; i += 10) {
    NavProtection p;
    p.stamp = start + milliseconds(10 * i);
    p.risk = 1e-4;
    p.along = p.across = 4.0;
    p.horizontal = i < 1000 ? 12.0 : 4.5;
    p.doubted = i < 500;
    levels.push_back(p);
  }
  const auto scored = score(levels, track(), reference(0.1), Time::min());
  ASSERT_TRUE(scored);
  EXPECT_EQ(scored->risk, 1e-4);
  EXPECT_EQ(scored->moments.size(), 201u);
  EXPECT_EQ(scored->doubted, 50u);
  EXPECT_EQ(scored->along.beyond, 50u) << "5 m, from 5 to 10 s";
  EXPECT_EQ(scored->across.beyond, 0u);
  EXPECT_EQ(scored->horizontal.beyond, 0u);
  EXPECT_NEAR(scored->largest_ratio, 5.0 / 12.0, 1e-3);
  EXPECT_NEAR(scored->horizontal.median, 4.5, 1e-9);
  EXPECT_NEAR(scored->below_5, 101.0 / 201.0, 1e-9);
  EXPECT_NEAR(scored->below_10, scored->below_5, 1e-9);
  EXPECT_EQ(score(levels, track(), reference(0.5), Time::min())->moments.size(), 101u)
      << "only where the reference is good enough";
  EXPECT_FALSE(score(levels, track(), {}, Time::min()));
  EXPECT_FALSE(score({}, track(), reference(0.1), Time::min()));
}

// The fixes are on the reference's path, twice a second.
TEST(OutageEnds, AreWhereTheStateIsAtTheLastFixThatWasTakenAway) {
  std::vector<GnssFix> fixes(41);
  for (int i = 0; i <= 40; ++i) {
    GnssFix& fix = fixes[static_cast<std::size_t>(i)];
    fix.stamp = start + milliseconds(500 * i + 30);  // between two states of the track
    fix.position = frame.to_geodetic({0.0, 10.0 * (0.5 * i + 0.03), 0.0});
    fix.position_covariance = 3.5 * Eigen::Matrix3d::Identity();
  }
  const auto at = [](double seconds) { return start + from_seconds(seconds); };
  const auto ends =
      outage_ends(track(), fixes, reference(0.1),
                  {{at(5.0), at(8.0)}, {at(12.0), at(13.0)}, {at(30.0), at(40.0)}}, start);
  ASSERT_EQ(ends.size(), 2u);  // nothing is known of the third
  EXPECT_NEAR(ends[0].error, 5.0, 1e-3);
  EXPECT_NEAR(ends[0].distance, 30.0, 1e-3);  // from 4.53 to 7.53 s
  EXPECT_NEAR(ends[0].length, 2.53, 1e-9);
  EXPECT_NEAR(ends[0].sigma, 3.0, 1e-6);  // 2 and 7 m^2
  EXPECT_NEAR(*ends[0].peer, 0.0, 1e-3);
  EXPECT_NEAR(ends[1].error, 1.0, 1e-3);
  EXPECT_FALSE(outage_ends(track(), fixes, {}, {{at(5.0), at(8.0)}}, start)[0].peer);
}

TEST(FusionScore, BeginsWhereItIsToldTo) {
  const std::vector<vehicle::GnssOutage> outages{
      {start + from_seconds(2), start + from_seconds(4)}};
  const auto score = fusion_score::score(track(), reference(0.1), outages, start, Time::max(),
                                         start + from_seconds(10));
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->whole.rmse, 1.0, 1e-3);
  EXPECT_NEAR(score->whole.distance, 100.0, 1e-3);
  EXPECT_NEAR(score->whole.covered, 1.0, 1e-9);
  EXPECT_NEAR(score->outages.at(0).errors.rmse, 5.0, 1e-3) << "as they are";
}

std::optional<Score> score_against(double accuracy) {
  return score(track(), reference(accuracy), {}, start);
}

TEST(FusionScore, CountsWhereTheReferenceIsGoodAlone) {
  const auto score = score_against(1.0);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->whole.rmse, 1.0, 1e-3);
  EXPECT_NEAR(score->whole.max, 1.0, 1e-3);
  EXPECT_NEAR(score->whole.distance, 99.0, 1.1);
  EXPECT_NEAR(score->whole.covered, 0.5, 0.01);
  EXPECT_DOUBLE_EQ(score->reference_accuracy, 0.1);
  EXPECT_NE(to_text(*score).find("better than 0.3 m: 50 % of the time"), std::string::npos);
}

TEST(FusionScore, CountsEverywhereWhereTheReferenceIsGood) {
  const auto score = score_against(0.2);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->whole.rmse, std::sqrt((25.0 + 1.0) / 2.0), 0.02);
  EXPECT_EQ(score->whole.covered, 1.0);
  EXPECT_EQ(to_text(*score).find("% of the time"), std::string::npos);
}

// The reference's own variance at that time is part of the expected error.
TEST(FusionScore, TheReferencesVarianceIsThatOfTheMoment) {
  const auto score = score_against(0.2);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->whole.nees_mean, (100.0 * 25.0 / 1.04 + 101.0 / 1.01) / 201.0, 1e-6);
}

TEST(FusionScore, TheLongestTimeBeyondThreeSigmasIsInOneGo) {
  const auto score = score_against(0.2);
  ASSERT_TRUE(score);
  // The NEES is 24 for the first ten seconds, and 1 after.
  EXPECT_NEAR(score->whole.beyond, 9.9, 1e-9);
  EXPECT_NEAR(score->whole.nees_max, 25.0 / 1.04, 1e-3);
  EXPECT_EQ(score->whole.azimuth_beyond, 0.0);
  EXPECT_NEAR(score->unsaid, 9.9, 1e-9);
}

TEST(FusionScore, WhatWasNamedIsNotUnsaidAnyMore) {
  const auto named = score(track(), reference(0.2), {}, start, start + from_seconds(4.0));
  ASSERT_TRUE(named);
  EXPECT_NEAR(named->unsaid, 3.9, 1e-9);
  EXPECT_NEAR(named->whole.beyond, 9.9, 1e-9);
}

}  // namespace
}  // namespace maploop::fusion_score
