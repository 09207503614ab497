// Tests the height of the ground as a measurement of the PPP filter.
#include "ppp/filter/height_update.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

using S = FilterState;
using maploop::testing::TemporaryFolder;

const Geodetic place{radians(49.51), radians(11.28), 200.0};
constexpr GroundParameters usual{};

// Makes a state at this distance from the place.
FilterState state_at(const Eigen::Vector3d& enu, double sigma) {
  FilterState state;
  const Eigen::Vector3d p = ecef_from_geodetic(place) + rotation_enu_ecef(place).transpose() * enu;
  for (int i = 0; i < 3; ++i) {
    state.set(S::position + i, p[i], sigma);
    state.set(S::velocity + i, 0.0, 1.0);
  }
  return state;
}

double height(const FilterState& state) {
  return geodetic_from_ecef(state.x().segment<3>(S::position)).height;
}

double sigma_up(const FilterState& state) {
  const Eigen::Vector3d up = rotation_enu_ecef(place).row(2);
  return std::sqrt(up.dot(state.P().block<3, 3>(S::position, S::position) * up));
}

// A model with tiles of one height, except the marked sample rows in the south, which are void.
class FlatGround {
 public:
  explicit FlatGround(std::int16_t height, int void_rows = 0)
      : model_((write(folder_.path(), height, void_rows), folder_.path()), "none") {}
  operator const HeightModel&() const { return model_; }

 private:
  static void write(const std::filesystem::path& folder, std::int16_t height, int void_rows) {
    constexpr int side = 1201;
    std::ofstream out(folder / "N49E011.hgt", std::ios::binary);
    for (int i = 0; i < side * side; ++i) {
      const auto value = static_cast<std::uint16_t>(i / side >= side - void_rows ? -32768 : height);
      out.put(static_cast<char>(value >> 8U)).put(static_cast<char>(value & 0xffU));
    }
  }

  TemporaryFolder folder_;
  HeightModel model_;
};

HeightUse apply(FilterState& state, const HeightModel& model, const GroundParameters& p = usual) {
  Eigen::VectorXd dx(S::capacity);
  return apply_height(state, model, p, dx);
}

TEST(HeightRow, AgreesWithNumericalDerivatives) {
  const Eigen::Vector2d slope(0.12, -0.07);
  // A sloping plane through the place, in the local frame.
  const auto row_of = [&](const FilterState& s) {
    const Eigen::Vector3d p =
        rotation_enu_ecef(place) * (s.x().segment<3>(S::position) - ecef_from_geodetic(place));
    return height_row(s, {HeightUse::used, 205.0 + slope.dot(p.head<2>()), slope}, usual);
  };
  FilterState state = state_at({3, -4, 1}, 2.0);
  state.set(S::ground_datum, 0.7, 3.0);
  state.set(S::ground_error, -1.1, 4.0);
  const LinearRow row = row_of(state);
  Eigen::VectorXd h = Eigen::VectorXd::Zero(state.size());
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
    h[row.indices[k]] = row.h[k];
  for (int i = 0; i < state.size(); ++i) {
    constexpr double step = 1.0;
    FilterState up = state, down = state;
    up.x()[i] += step;
    down.x()[i] -= step;
    EXPECT_NEAR(-(row_of(up).y - row_of(down).y) / (2.0 * step), h[i], 2e-6) << i;
  }
}

TEST(HeightRow, AnUncertainPlaceMakesItsSlopeCount) {
  const Ground ground{HeightUse::used, 200.0, {0.0, 0.0}};
  const double near = height_row(state_at({0, 0, 0}, 0.1), ground, usual).variance;
  const double far = height_row(state_at({0, 0, 0}, 60.0), ground, usual).variance;
  EXPECT_NEAR(near, usual.noise * usual.noise, 1e-3);
  EXPECT_NEAR(std::sqrt(far), usual.slope_sigma * 60.0 * std::sqrt(2.0), 0.05);
}

TEST(HeightUpdate, BringsAnUnknownHeightToTheAntennaAboveTheGround) {
  FilterState state = state_at({0, 0, 40}, 60.0);
  ASSERT_EQ(apply(state, FlatGround(150)), HeightUse::used);
  EXPECT_NEAR(height(state), 150.0 - usual.surface + usual.antenna_height, 2.0);
  const double slope = usual.slope_sigma * 60.0 * std::sqrt(2.0);
  EXPECT_NEAR(sigma_up(state), std::hypot(usual.datum_sigma, usual.error_sigma, slope), 0.1);
}

TEST(HeightUpdate, ManyAtOnePlaceAreNoBetterThanTheModel) {
  FilterState state = state_at({0, 0, 0}, 60.0);
  const FlatGround ground(200);
  for (int i = 0; i < 1000; ++i) {
    apply(state, ground);
    predict_height_states(state, 1.0, usual);
  }
  EXPECT_GT(sigma_up(state), 0.95 * std::hypot(usual.datum_sigma, usual.error_sigma));
}

TEST(HeightUpdate, AlongTheWayOnlyTheDatumRemains) {
  FilterState state = state_at({0, 0, 0}, 60.0);
  state.x().segment<3>(S::velocity) = Eigen::Vector3d(20.0, 0.0, 0.0);
  const FlatGround ground(200);
  for (int i = 0; i < 2000; ++i) {
    apply(state, ground);
    predict_height_states(state, 1.0, usual);
  }
  EXPECT_LT(sigma_up(state), 1.1 * usual.datum_sigma);
  EXPECT_GT(sigma_up(state), 0.95 * usual.datum_sigma);
}

TEST(HeightUpdate, WhatWasLearntUnderOpenSkyStays) {
  FilterState state = state_at({0, 0, 0}, 0.1);
  const FlatGround ground(206);  // the datum is off
  ASSERT_EQ(apply(state, ground), HeightUse::used);
  const Eigen::Vector3d up = rotation_enu_ecef(place).row(2);
  for (int i = 0; i < 3; ++i) {
    state.set(S::position + i, state.x()[S::position + i] + 9.0 * up[i], 10.0);
  }
  ASSERT_EQ(apply(state, ground), HeightUse::used);
  EXPECT_NEAR(height(state), 200.0, 0.3) << "at the same place, to the noise of each epoch";
  EXPECT_LT(sigma_up(state), 1.1);
}

TEST(HeightUpdate, ABridgeIsGatedAndChangesNothing) {
  FilterState state = state_at({0, 0, 0}, 0.5);
  ASSERT_EQ(apply(state, FlatGround(201)), HeightUse::used);
  const Eigen::VectorXd before = state.x();
  EXPECT_EQ(apply(state, FlatGround(170)), HeightUse::gated);
  EXPECT_EQ(Eigen::VectorXd(state.x()), before);
}

TEST(HeightUpdate, VoidsAndOtherPlacesAreRefused) {
  FilterState state = state_at({0, 0, 0}, 2.0);
  const Eigen::VectorXd before = state.x();
  EXPECT_EQ(apply(state, FlatGround(200, 1201)), HeightUse::no_height);
  state.x()[S::position + 2] -= 200'000.0;
  EXPECT_EQ(apply(state, FlatGround(200)), HeightUse::no_tile);
  EXPECT_EQ(state.P()(S::ground_error, S::ground_error), 0.0) << "no state is opened";
}

}  // namespace
}  // namespace maploop::ppp
