#include "ppp/filter/filter_state.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/support/broken_archives.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

FilterState some_state() {
  FilterState state;
  for (int i = 0; i < S::fixed; ++i) state.set(i, 0.1 * i, 1.0 + i);
  state.add({System::gps, 5}, Part::ambiguity, 3.0, 60.0);
  state.add({System::galileo, 12}, Part::ionosphere, -7.0, 60.0);
  state.add({System::gps, 31}, Part::ambiguity, 1.0, 60.0);
  return state;
}

TEST(FilterState, ScalarUpdatesAreTheBatchUpdate) {
  FilterState state = some_state();
  const int n = state.size();
  const Eigen::MatrixXd P = state.P();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int rows = 11;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(rows, n);
  Eigen::VectorXd y(rows), dx = Eigen::VectorXd::Zero(S::capacity);
  for (int r = 0; r < rows; ++r) {
    const std::array<int, 4> indices{r % n, (r + 5) % n, (r + 9) % n, n - 1};
    std::array<double, 4> h{};
    for (std::size_t k = 0; k < 4; ++k) H(r, indices[k]) = h[k] = normal(random);
    y[r] = normal(random);
    state.update(indices, h, y[r], 0.25, dx);
  }
  const Eigen::MatrixXd innovation =
      H * P * H.transpose() + 0.25 * Eigen::MatrixXd::Identity(rows, rows);
  const Eigen::MatrixXd K = P * H.transpose() * innovation.inverse();
  EXPECT_LT((dx.head(n) - K * y).norm(), 1e-9);
  EXPECT_LT((state.P() - (P - K * H * P)).norm() / P.norm(), 1e-12);
  EXPECT_EQ((state.P() - state.P().transpose()).norm(), 0.0);
}

TEST(FilterState, RemovingAnEntryKeepsTheOthers) {
  FilterState state = some_state();
  Eigen::VectorXd dx = Eigen::VectorXd::Zero(S::capacity);
  const std::array<int, 3> indices{0, S::fixed, S::fixed + 2};
  const std::array<double, 3> h{1.0, 1.0, 0.5};
  state.update(indices, h, 1.0, 0.01, dx);
  const int last = state.find({System::gps, 31}, Part::ambiguity);
  const double variance = state.P()(last, last), with_position = state.P()(0, last);
  state.remove({System::gps, 5}, Part::ambiguity);
  const int now = state.find({System::gps, 31}, Part::ambiguity);
  EXPECT_EQ(now, S::fixed);
  EXPECT_EQ(state.P()(now, now), variance);
  EXPECT_EQ(state.P()(0, now), with_position);
  EXPECT_EQ(state.P()(now, 0), with_position);
  EXPECT_EQ(state.find({System::gps, 5}, Part::ambiguity), -1);
  EXPECT_EQ(state.find({System::galileo, 12}, Part::ionosphere), S::fixed + 1);
}

TEST(FilterState, HasRoomForALimitedNumber) {
  FilterState state;
  for (int i = 0; i < S::max_entries; ++i) {
    const Satellite satellite{i < 99 ? System::gps : System::galileo,
                              static_cast<std::uint8_t>(1 + i % 99)};
    EXPECT_GE(state.add(satellite, Part::ionosphere, 0, 1), 0);
  }
  EXPECT_EQ(state.add({System::beidou, 1}, Part::ionosphere, 0, 1), -1);
}

TEST(FilterState, AForgottenErrorReturnsToItsVariance) {
  FilterState state = some_state();
  state.forget(S::zenith_ionosphere, 0.5, 9.0);
  const double before = 1.0 + S::zenith_ionosphere;
  EXPECT_NEAR(state.x()[S::zenith_ionosphere], 0.05 * S::zenith_ionosphere, 1e-12);
  EXPECT_NEAR(state.P()(S::zenith_ionosphere, S::zenith_ionosphere),
              0.25 * before * before + 0.75 * 9.0, 1e-9);
}

TEST(FilterState, IsSavedAndLoaded) {
  FilterState state = some_state(), other;
  const Bytes archive = maploop::testing::saved(state);
  maploop::testing::load(archive, other);
  EXPECT_EQ(maploop::testing::saved(other), archive);
  EXPECT_EQ(other.find({System::galileo, 12}, Part::ionosphere), S::fixed + 1);
}

}  // namespace
}  // namespace maploop::ppp
