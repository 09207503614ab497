#include "ppp/filter/robust_update.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace maploop::ppp {
namespace {

using S = FilterState;

Satellite gps(int number) {
  return {System::gps, static_cast<std::uint8_t>(number)};
}

// The rows are the codes and phases of nine satellites, whose ambiguities are known to a
// centimetre. The vehicle has moved by an unknown displacement with a standard deviation of a metre
// per axis.
class NineSatellites : public ::testing::Test {
 protected:
  static constexpr int satellites = 9;

  NineSatellites() {
    for (int i = 0; i < 3; ++i) state_.set(S::position + i, 0.0, 1.0);
    state_.set(S::clock, 0.0, 100.0);
    for (int s = 0; s < satellites; ++s) {
      state_.add(gps(s + 1), Part::ambiguity, 0.0, 0.01);
      Eigen::Vector3d to_satellite(std::cos(0.7 * s), std::sin(0.7 * s), 0.3 + 0.2 * (s % 5));
      to_satellite.normalize();
      Row code;
      code.kind = RowKind::code;
      for (int i = 0; i < 3; ++i) code.add(S::position + i, -to_satellite[i]);
      code.add(S::clock, 1.0);
      code.y = 7.0 - to_satellite.dot(moved) + 0.8 * normal_(random_);
      code.sigma = 1.0;
      code.most_sigmas = PppParameters{}.outlier_sigmas;
      code.variance = 80.0;
      Row phase = code;
      phase.kind = RowKind::phase;
      phase.add(state_.find(gps(s + 1), Part::ambiguity), 1.0);
      phase.y = 7.0 - to_satellite.dot(moved) + 0.01 * normal_(random_);
      phase.sigma = 0.01;
      phase.variance = 1e-4;
      rows_.push_back(code);
      rows_.push_back(phase);
    }
  }
  Row& phase(int satellite) { return rows_[2 * static_cast<std::size_t>(satellite) + 1]; }
  Row& code(int satellite) { return rows_[2 * static_cast<std::size_t>(satellite)]; }
  std::vector<int> left_out() const {
    std::vector<int> which;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].active) which.push_back(static_cast<int>(i));
    }
    return which;
  }
  double error() const { return (state_.x().segment<3>(S::position) - moved).norm(); }

  const Eigen::Vector3d moved{0.7, -0.4, 0.3};
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
  FilterState state_;
  std::vector<Row> rows_;
  RobustUpdate update_{PppParameters{}};
};

TEST_F(NineSatellites, NothingIsLeftOutWhereAllFits) {
  update_.apply(state_, rows_);
  EXPECT_EQ(left_out(), std::vector<int>{});
  EXPECT_LT(error(), 0.03);
}

TEST_F(NineSatellites, ASlipOfAnySatelliteIsLeftOut) {
  for (int slipped = 0; slipped < satellites; ++slipped) {
    const FilterState before = state_;
    const std::vector<Row> all = rows_;
    phase(slipped).y += 0.4;
    update_.apply(state_, rows_);
    EXPECT_EQ(left_out(), std::vector<int>{2 * slipped + 1});
    EXPECT_LT(error(), 0.04);
    state_ = before;
    rows_ = all;
  }
}

// Removing the worst row one at a time would remove good ones first.
TEST_F(NineSatellites, ThreeSlipsOfNineAreTheOnesLeftOut) {
  phase(1).y += 3.0;
  phase(4).y += 5.0;
  phase(6).y -= 4.0;
  update_.apply(state_, rows_);
  EXPECT_EQ(left_out(), (std::vector<int>{3, 9, 13}));
  EXPECT_LT(error(), 0.05);
}

TEST_F(NineSatellites, ACodeIsJudgedByItsSize) {
  code(2).y += 1.5;
  code(5).y += 6.0;
  update_.apply(state_, rows_);
  EXPECT_EQ(left_out(), std::vector<int>{10});
}

// Any four phases fit. A wrong choice of them would move the vehicle, and good ambiguities would be
// lost.
TEST_F(NineSatellites, PhasesWithoutRedundancyMoveItLittleAndAreKept) {
  for (int lost = 5; lost < satellites; ++lost) {
    state_.set(state_.find(gps(lost + 1), Part::ambiguity), 0.0, 60.0);
    phase(lost).new_ambiguity = true;
  }
  phase(0).y += 8.0;
  update_.apply(state_, rows_);
  int kept = 0;
  for (int known = 0; known < 5; ++known) kept += phase(known).active || phase(known).doubtful;
  EXPECT_EQ(kept, 5);
  for (int known = 0; known < 5; ++known) {
    const int ambiguity = state_.find(gps(known + 1), Part::ambiguity);
    EXPECT_EQ(std::sqrt(state_.P()(ambiguity, ambiguity)) > 1.0, phase(known).doubtful) << known;
  }
  EXPECT_LT(error(), 1.5);
  const auto P = state_.P().block<3, 3>(S::position, S::position);
  EXPECT_GT(std::sqrt(P.trace()), 0.5);  // the covariance accounts for it
}

// A phase with a new ambiguity cannot contradict the state.
TEST_F(NineSatellites, ANewAmbiguityIsNeverAMisfit) {
  state_.set(state_.find(gps(4), Part::ambiguity), 0.0, 60.0);
  phase(3).y += 50.0;
  update_.apply(state_, rows_);
  EXPECT_EQ(left_out(), std::vector<int>{});
  EXPECT_NEAR(state_.x()[state_.find(gps(4), Part::ambiguity)], 50.0, 0.1);
}

}  // namespace
}  // namespace maploop::ppp
