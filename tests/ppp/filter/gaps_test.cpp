// Leaves out epochs and satellites of a real drive, and what a receiver loses with its power.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ppp/gnss_files.h"
#include "tests/support/real_data.h"
#include "tools/ppp/position_files.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::ppp {
namespace {

using gnss::Accuracy;
using gnss::PppRun;
using gnss::RunOptions;
using gnss::Score;
using gnss::Truth;

std::filesystem::path folder() {
  return maploop::testing::real_data() / "gnss/riverside_drive";
}

const GnssFiles& drive() {
  static const GnssFiles files = [] {
    GnssFiles read;
    for (const char* name : {"COM3_200712.obs.gz", "COM3_200712.nav.gz"})
      read_into(folder() / name, read);
    return read;
  }();
  return files;
}

GpsTime first() {
  return drive().observations.at(0).epochs.front().time;
}

void lose_lock(Epoch& epoch) {
  for (Signal& s : epoch.signals) s.lost_lock = true;
}

void keep_satellites(Epoch& epoch, std::size_t count) {
  if (epoch.satellites.size() > count) epoch.satellites.resize(count);
}

struct Driven {
  Accuracy after;  // the gap
  std::size_t misleading = 0;
  std::uint64_t restarts = 0;
};

// The receiver loses lock in the gap or keeps it.
Driven drive_with_gap(double begin, double length, bool loses_lock,
                      const PppParameters& parameters = {}) {
  RunOptions options;
  options.parameters = parameters;
  const GpsTime end = first() + from_seconds(begin + length);
  options.outages.emplace_back(first() + from_seconds(begin), end);
  options.end = end + std::chrono::seconds(300);
  bool lost = !loses_lock;
  options.change = [&](Epoch& epoch) {
    if (lost || epoch.time < end) return;
    lose_lock(epoch);
    lost = true;
  };
  PppRun run(drive(), options);
  const Truth truth((folder() / "groundtruth.csv.gz").string(), first());
  Score score(truth, 1e-4);
  Driven driven;
  run.process([&](const PppSolution& s) {
    score.add(s);
    driven.restarts = s.restarts;
  });
  driven.after = score.accuracy(end);
  driven.misleading = score.misleading();
  return driven;
}

TEST(Gaps, AfterAGapOfAnyLengthTheCarIsFoundAsByAFirstPosition) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const double length : {20.0, 60.0, 180.0, 900.0, 3000.0}) {
    for (const bool loses_lock : {false, true}) {
      const Driven driven = drive_with_gap(300.0, length, loses_lock);
      EXPECT_EQ(driven.after.solved, driven.after.with_truth) << length << ' ' << loses_lock;
      EXPECT_LT(driven.after.horizontal_rmse, 1.0) << length << ' ' << loses_lock;
      EXPECT_LT(driven.after.up_rmse, 1.6) << length << ' ' << loses_lock;
      EXPECT_LT(driven.after.nees, 4.0) << length << ' ' << loses_lock;
      EXPECT_EQ(driven.misleading, 0U) << length << ' ' << loses_lock;
      EXPECT_EQ(driven.restarts, 0U) << length << ' ' << loses_lock;
    }
  }
}

// Without the start from codes the filter is so wrong that few codes are near its position.
TEST(Gaps, AFilterThatHasGoneAstrayStartsAgain) {
  MAPLOOP_REQUIRE_REAL_DATA();
  PppParameters parameters;
  parameters.lost_position_sigma = 1e9;
  const Driven driven = drive_with_gap(300.0, 3000.0, true, parameters);
  EXPECT_GE(driven.restarts, 1U);
  EXPECT_LT(driven.after.three_d_last, 3.0);
}

// Runs 60 s into a time of `few` satellites.
std::vector<PppSolution> drive_with_few(std::size_t few, double bridged_sigma) {
  RunOptions options;
  options.parameters.bridged_sigma = bridged_sigma;
  const GpsTime begin = first() + std::chrono::seconds(600);
  options.start = first() + std::chrono::seconds(300);
  options.end = begin + std::chrono::seconds(59);
  options.change = [&](Epoch& epoch) {
    if (epoch.time >= begin) keep_satellites(epoch, few);
  };
  PppRun run(drive(), options);
  std::vector<PppSolution> solutions;
  run.process([&](const PppSolution& s) {
    if (s.time >= begin) solutions.push_back(s);
  });
  return solutions;
}

TEST(Gaps, PositionsAreBridgedWhileTheirSigmaIsSmall) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Truth truth((folder() / "groundtruth.csv.gz").string(), first());
  for (const std::size_t few : {0U, 2U, 3U}) {
    const auto solutions = drive_with_few(few, 30.0);
    int bridged = 0;
    for (const PppSolution& s : solutions) {
      EXPECT_EQ(s.status, PppStatus::none);
      EXPECT_FALSE(s.message.empty());
      if (!s.bridged) continue;
      ++bridged;
      const auto place = truth.at(s.time);
      ASSERT_TRUE(place);
      const double sigma = std::sqrt(s.covariance.trace());
      EXPECT_LT((s.position - *place).norm(), 3.0 * sigma) << few << ' ' << bridged;
    }
    EXPECT_GE(bridged, few == 0 ? 4 : 8) << few;
    EXPECT_TRUE(solutions.front().bridged);
    EXPECT_LE(bridged, few == 0 ? 10 : 60) << few;
    const auto none = drive_with_few(few, 0.0);
    EXPECT_TRUE(std::ranges::none_of(none, &PppSolution::has_position));
  }
}

TEST(Gaps, FilesMarkBridgedPositions) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto all = drive_with_few(2, 30.0);
  const std::vector<PppSolution> one{all.front()};
  EXPECT_NE(gnss::to_pos(one, false, "").find("   7   "), std::string::npos);
  const std::string nmea = gnss::to_nmea(one);
  EXPECT_NE(nmea.find("W,6,"), std::string::npos) << nmea;
  EXPECT_NE(nmea.find(",,,E*"), std::string::npos) << nmea;
}

// The power fails before the epoch of this index.
std::vector<PppSolution> drive_with_power_failure(std::optional<std::size_t> failure) {
  RunOptions options;
  options.end = first() + std::chrono::seconds(400);
  std::size_t epochs = 0;
  options.change = [&](Epoch& epoch) {
    epoch.power_failure = failure == epochs;
    ++epochs;
  };
  PppRun run(drive(), options);
  std::vector<PppSolution> solutions;
  run.process([&](const PppSolution& s) { solutions.push_back(s); });
  return solutions;
}

TEST(Gaps, AfterAPowerFailureAllAmbiguitiesAreNew) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto without = drive_with_power_failure({}), with = drive_with_power_failure(300);
  const auto sigma = [](const PppSolution& s) { return std::sqrt(s.covariance.trace()); };
  EXPECT_EQ(with[299].position, without[299].position);
  EXPECT_GT(sigma(with[310]), 1.02 * sigma(without[310]));
  EXPECT_LT((with.back().position - without.back().position).norm(), 3.0 * sigma(with.back()));
  EXPECT_EQ(with.back().restarts, 0U);
}

TEST(Gaps, APowerFailureBeforeTheFirstEpochChangesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto without = drive_with_power_failure({}), with = drive_with_power_failure(0);
  for (std::size_t i = 0; i < without.size(); ++i)
    ASSERT_EQ(with[i].position, without[i].position) << i;
}

}  // namespace
}  // namespace maploop::ppp
