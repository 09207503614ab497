// Tests the road as a measurement of the PPP filter: its equations, and which states it may change.
#include "ppp/filter/map_update.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

const Geodetic place{radians(33.98), radians(-117.33), 250.0};

// Makes feedback of a road with this azimuth through the place.
MapFeedback road(double azimuth = 0.0) {
  MapFeedback f;
  f.reason = FeedbackReason::none;
  f.position = true;
  f.point = place;
  f.link_azimuth = azimuth;
  f.cross_sigma = 1.0;
  f.lane_sigma = 1.7;
  f.azimuth_sigma = 0.05;
  f.probability = 1.0;
  return f;
}

Eigen::Vector3d earth_fixed(const Eigen::Vector3d& enu) {
  return rotation_enu_ecef(place).transpose() * enu;
}

// Makes a state at this distance from the place, with 2 m and 1 m/s per axis.
FilterState state_at(const Eigen::Vector3d& enu = {0, 0, 0},
                     const Eigen::Vector3d& velocity_enu = {0, 10, 0}) {
  FilterState state;
  const Eigen::Vector3d p = ecef_from_geodetic(place) + earth_fixed(enu);
  const Eigen::Vector3d v = earth_fixed(velocity_enu);
  for (int i = 0; i < 3; ++i) {
    state.set(S::position + i, p[i], 2.0);
    state.set(S::velocity + i, v[i], 1.0);
  }
  begin_map_states(state, {});
  return state;
}

Eigen::Vector3d position_enu(const FilterState& state) {
  const Eigen::Vector3d p = state.x().segment<3>(S::position);
  return rotation_enu_ecef(place) * (p - ecef_from_geodetic(place));
}

// Returns the covariance of the position, east and north.
Eigen::Matrix2d covariance(const FilterState& state) {
  Eigen::Matrix<double, 2, S::fixed> H = Eigen::Matrix<double, 2, S::fixed>::Zero();
  H.middleCols<3>(S::position) = rotation_enu_ecef(place).topRows<2>();
  return H * state.P().topLeftCorner<S::fixed, S::fixed>() * H.transpose();
}

MapUse apply(FilterState& state, const MapFeedback& feedback, const PppParameters& p = {}) {
  Eigen::VectorXd dx(S::capacity);
  return apply_map(state, feedback, 0.0, covariance(state), p, dx);
}

double sigma_east(const FilterState& state) {
  return std::sqrt(covariance(state)(0, 0));
}

template <class MakeRow>
void expect_numerical_derivative(const FilterState& state, MakeRow&& make) {
  const LinearRow row = make(state);
  Eigen::VectorXd h = Eigen::VectorXd::Zero(state.size());
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k)
    h[row.indices[k]] = row.h[k];
  for (int i = 0; i < state.size(); ++i) {
    constexpr double step = 1.0;  // the rows are linear; at 6e6 m a smaller one is lost in rounding
    FilterState up = state, down = state;
    up.x()[i] += step;
    down.x()[i] -= step;
    EXPECT_NEAR(-(make(up).y - make(down).y) / (2.0 * step), h[i], 1e-8) << i;
  }
}

TEST(MapRows, AgreeWithNumericalDerivatives) {
  FilterState state = state_at({3, -4, 1}, {6, 7, 0.2});
  state.add({System::gps, 5}, Part::ambiguity, 3.0, 60.0);
  for (int i = S::map_datum; i <= S::lane_offset; ++i) state.x()[i] = 0.1 * i;
  const MapFeedback f = road(2.2);
  expect_numerical_derivative(state, [&](const FilterState& s) { return line_row(s, f, -0.3); });
  expect_numerical_derivative(state,
                              [&](const FilterState& s) { return direction_row(s, f, 0.1); });
}

TEST(MapRows, ALineIsSignedToTheRightOfTheWayDriven) {
  EXPECT_NEAR(line_row(state_at({3, 0, 0}), road(), 0.0).y, -3.0, 1e-6) << "northwards";
  EXPECT_NEAR(line_row(state_at({3, 0, 0}), road(std::numbers::pi), 0.0).y, 3.0, 1e-6)
      << "southwards";
  EXPECT_NEAR(line_row(state_at({0, 3, 5}), road(), 0.0).y, 0.0, 1e-5) << "along and up";
  EXPECT_NEAR(line_row(state_at({0, 0, 0}, {10, 0, 0}), road(), 0.2).y, -2.0, 1e-6) << "later";
}

TEST(MapUpdate, ConstrainsNeitherTheWayAlongTheRoadNorTheHeight) {
  FilterState state = state_at({3, 0, 0});
  const Eigen::Matrix2d before = covariance(state);
  ASSERT_EQ(apply(state, road()), MapUse::used);
  const Eigen::Vector3d p = position_enu(state);
  EXPECT_LT(p.x(), 2.0);
  EXPECT_NEAR(p.y(), 0.0, 1e-6);
  EXPECT_NEAR(p.z(), 0.0, 1e-6);
  EXPECT_LT(covariance(state)(0, 0), 0.7 * before(0, 0));
  EXPECT_NEAR(covariance(state)(1, 1), before(1, 1), 1e-9);
}

TEST(MapUpdate, ManyLinesOfOneRoadAreNoBetterThanItsLaneAndTheDatum) {
  PppParameters p;
  FilterState state = state_at({3, 0, 0});
  for (int i = 0; i < 1000; ++i) apply(state, road(), p);
  // This is the information of the prior (2 m) and of the parts that are constant along the road.
  const double known = 1.0 / 4.0 + 1.0 / (1.7 * 1.7 + p.map_datum_sigma * p.map_datum_sigma);
  EXPECT_GT(sigma_east(state), 0.999 * std::sqrt(1.0 / known));
  EXPECT_LT(sigma_east(state), 1.01 * std::sqrt(1.0 / known));
}

TEST(MapUpdate, AnotherRoadHasAnotherLaneButTheSameDatum) {
  PppParameters p;
  FilterState same = state_at(), other = state_at();
  for (int i = 0; i < 300; ++i) {
    MapFeedback f = road();
    apply(same, f, p);
    f.new_road = i % 10 == 0;
    apply(other, f, p);
  }
  EXPECT_LT(sigma_east(other), 0.8 * sigma_east(same));
  const double with_datum =
      std::sqrt(1.0 / (1.0 / 4.0 + 1.0 / (p.map_datum_sigma * p.map_datum_sigma)));
  EXPECT_GT(sigma_east(other), with_datum);
}

TEST(MapUpdate, TheLaneIsForgottenWithTheWayAndNotWithTime) {
  PppParameters p;
  FilterState state = state_at({1, 0, 0});
  for (int i = 0; i < 100; ++i) apply(state, road(), p);
  const double lane = state.x()[S::lane_offset];
  ASSERT_GT(std::abs(lane), 0.01);
  FilterState standing = state;
  standing.x().segment<3>(S::velocity).setZero();
  predict_map_states(standing, 60.0, p);
  EXPECT_EQ(standing.x()[S::lane_offset], lane);
  const double speed = state.x().segment<3>(S::velocity).norm();
  predict_map_states(state, p.map_lane_length / speed, p);
  EXPECT_NEAR(state.x()[S::lane_offset] / lane, std::exp(-1.0), 1e-9);
  for (int i = 0; i < 20; ++i) predict_map_states(state, p.map_lane_length / speed, p);
  EXPECT_NEAR(state.P()(S::lane_offset, S::lane_offset), 1.0, 1e-6);
}

TEST(MapUpdate, ALinkOfProbabilityHalfHasTwiceTheVariance) {
  const FilterState state = state_at();
  MapFeedback f = road();
  const double all = f.lane_sigma * f.lane_sigma;
  const double sure = line_row(state, f, 0.0).variance + all;
  f.probability = 0.5;
  EXPECT_NEAR(line_row(state, f, 0.0).variance + all, 2.0 * sure, 1e-9);
}

TEST(MapUpdate, ADirectionHoldsTheVelocityInTheRoad) {
  MapFeedback f = road();
  f.position = false;
  f.azimuth = true;
  FilterState state = state_at({0, 0, 0}, {1.0, 12.0, 0});
  ASSERT_EQ(apply(state, f), MapUse::used);
  const Eigen::Vector3d v = rotation_enu_ecef(place) * state.x().segment<3>(S::velocity);
  EXPECT_LT(v.x(), 0.5);
  EXPECT_NEAR(v.y(), 12.0, 1e-6);
  while (apply(state, f) == MapUse::used) {
  }
  EXPECT_EQ(apply(state, f), MapUse::no_help);
}

TEST(MapUpdate, WhatCannotBeUsedChangesNothing) {
  const FilterState before = state_at({9, 0, 0});
  const auto expect = [&](const MapFeedback& f, MapUse use) {
    FilterState state = before;
    EXPECT_EQ(apply(state, f), use) << to_string(use);
    EXPECT_EQ(state.x(), before.x());
    EXPECT_EQ(state.P(), before.P());
  };
  expect(road(), MapUse::gated);
  MapFeedback f = road();
  f.position = false;
  expect(f, MapUse::nothing_fed_back);
  f = road();
  f.cross_sigma = 0.0;
  expect(f, MapUse::not_usable);
  f = road();
  f.probability = 0.0;
  expect(f, MapUse::not_usable);
  for (double MapFeedback::*member : {&MapFeedback::link_azimuth, &MapFeedback::lane_sigma}) {
    f = road();
    f.*member = std::numeric_limits<double>::quiet_NaN();
    expect(f, MapUse::not_usable);
  }
}

}  // namespace
}  // namespace maploop::ppp
