// Tests the solutions that also know the later epochs.
#include "ppp/smoothing.h"

#include <gtest/gtest.h>

#include "ppp/gnss_files.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tools/ppp/run.h"
#include "tools/ppp/score.h"

namespace maploop::ppp {
namespace {

using gnss::Direction;

Epoch epoch_at(double seconds, bool lost_lock, bool power_failure = false) {
  Epoch epoch;
  epoch.time = GpsTime(from_seconds(seconds));
  epoch.power_failure = power_failure;
  epoch.satellites = {{{System::gps, 5}, 0, 1}};
  epoch.signals = {{.band = '1', .attribute = 'C', .lost_lock = lost_lock, .phase = 1.0}};
  return epoch;
}

TEST(Smoothing, ALossOfLockIsBetweenTheSameEpochsBackward) {
  std::vector<Epoch> epochs{epoch_at(0, true), epoch_at(1, false), epoch_at(2, true, true),
                            epoch_at(3, false)};
  const auto backward = reversed(epochs);
  ASSERT_EQ(backward.size(), 4U);
  EXPECT_EQ(backward[0].time, epochs[3].time);
  const bool lost[] = {false, false, true, false};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(backward[i].signals[0].lost_lock, lost[i]) << i;
    EXPECT_EQ(backward[i].power_failure, lost[i]) << i;
  }
}

TEST(Smoothing, ALossOfLockOfASatelliteThatWasAwayIsKept) {
  std::vector<Epoch> epochs{epoch_at(0, false), epoch_at(1, false), epoch_at(2, true)};
  epochs[1].satellites.clear();
  epochs[1].signals.clear();
  const auto backward = reversed(epochs);
  EXPECT_FALSE(backward[0].signals[0].lost_lock);
  EXPECT_TRUE(backward[2].signals[0].lost_lock);
}

PppSolution solution(PppStatus status, double x, double variance) {
  PppSolution s;
  s.status = status;
  s.position = {x, 0.0, 0.0};
  s.covariance = variance * Eigen::Matrix3d::Identity();
  return s;
}

TEST(Smoothing, TheMoreAccurateSolutionCountsMore) {
  const auto forward = solution(PppStatus::converging, 1.0, 1.0);
  const auto backward = solution(PppStatus::fixed, 0.0, 1e-4);
  const auto both = combined(forward, backward);
  EXPECT_NEAR(both.position.x(), 0.0, 1e-6);
  EXPECT_NEAR(both.covariance(1, 1), 1e-4, 1e-7);
  EXPECT_EQ(both.status, PppStatus::fixed);
  const auto equal = combined(forward, solution(PppStatus::converging, 0.0, 1.0));
  EXPECT_NEAR(equal.position.x(), 0.5, 1e-12);
  EXPECT_NEAR(equal.covariance(0, 0), 1.0, 1e-12) << "It claims no more than either.";
}

TEST(Smoothing, ABridgedPositionIsCombinedWithAMeasuredOne) {
  auto forward = solution(PppStatus::none, 1.0, 100.0);
  forward.bridged = true;
  const auto measured = combined(forward, solution(PppStatus::converging, 0.0, 1.0));
  EXPECT_EQ(measured.status, PppStatus::converging);
  EXPECT_FALSE(measured.bridged);
  EXPECT_NEAR(measured.position.x(), 0.0, 0.1);
  const auto both = combined(forward, forward);
  EXPECT_EQ(both.status, PppStatus::none);
  EXPECT_TRUE(both.bridged);
}

TEST(Smoothing, ASolutionWithoutAPositionIsNotCombined) {
  const auto forward = solution(PppStatus::converging, 1.0, 1.0);
  EXPECT_EQ(combined(forward, {}).position, forward.position);
  EXPECT_EQ(combined({}, forward).position, forward.position);
}

class SmoothedRun : public ::testing::Test {
 protected:
  gnss::Accuracy accuracy(Direction direction) const {
    gnss::RunOptions options;
    options.parameters.systems = "GE";
    options.direction = direction;
    options.start = start_;
    options.end = end_;
    gnss::PppRun run(files_, options);
    const gnss::Truth truth(place_, files_.observations[0].epochs.front().time);
    gnss::Score score(truth, 1e-4);
    GpsTime last{};
    run.process([&](const PppSolution& s) {
      EXPECT_GT(s.time, last) << "They come in the order of time.";
      last = s.time;
      score.add(s);
    });
    return score.accuracy(GpsTime{});
  }
  void read(const std::vector<std::string>& names) {
    for (const std::string& name : names)
      read_into(maploop::testing::real_data() / "gnss" / name, files_);
  }

  GnssFiles files_;
  std::string place_;
  std::optional<GpsTime> start_, end_;
};

// A cold start at noon: forward, the first quarter of an hour is metres off.
TEST_F(SmoothedRun, HasNoConvergence) {
  MAPLOOP_REQUIRE_REAL_DATA();
  read({"esbc_static/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
        "esbc_static/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
        "esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz", "models/igs14_rebuilt_GE.atx.gz",
        "models/igs05_receivers.atx.gz"});
  place_ = "3582104.7678,532590.1740,5232755.1436";
  start_ = gps_time({2020, 6, 25, 12, 0, 0.0});
  end_ = gps_time({2020, 6, 25, 13, 0, 0.0});
  const auto forward = accuracy(Direction::forward);
  const auto backward = accuracy(Direction::backward);
  const auto smoothed = accuracy(Direction::smoothed);
  EXPECT_GT(forward.horizontal_rmse, 0.05);
  EXPECT_LT(backward.horizontal_rmse, 0.048);
  EXPECT_LT(smoothed.horizontal_rmse, 0.015);
  EXPECT_LT(smoothed.up_rmse, 0.014);
  EXPECT_LT(smoothed.nees, 3.0);
  EXPECT_EQ(smoothed.solved, forward.solved);
}

TEST_F(SmoothedRun, OfACarAgreesWithItsReferenceAboutTheMean) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string car = "kamakura_kinematic/";
  read({car + "SEPT265G.21O.gz", car + "SEPT2650.21P.gz",
        car + "COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz",
        car + "COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz", "models/igs14_rebuilt_GE.atx.gz"});
  place_ = (maploop::testing::real_data() / "gnss" / car / "rtk_reference.pos.gz").string();
  EXPECT_GT(accuracy(Direction::forward).horizontal_rmse_without_mean, 0.1);
  const auto smoothed = accuracy(Direction::smoothed);
  EXPECT_LT(smoothed.horizontal_rmse_without_mean, 0.06);
  EXPECT_LT(smoothed.horizontal_rmse, 0.5);  // the reference's base is 0.3 m off
  EXPECT_LT(smoothed.nees, 3.0);
}

}  // namespace
}  // namespace maploop::ppp
