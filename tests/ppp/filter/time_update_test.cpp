// Tests the prediction of position and velocity.
#include "ppp/filter/time_update.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "ppp/products/precise.h"

namespace maploop::ppp {
namespace {

using S = FilterState;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

const Eigen::Vector3d place(3582104.7678, 532590.1740, 5232755.1436);

FilterState moving(const Eigen::Vector3d& velocity_enu) {
  FilterState state;
  begin_state(state, place, PppParameters{});
  state.x().segment<3>(S::velocity) =
      rotation_enu_ecef(geodetic_from_ecef(place)).transpose() * velocity_enu;
  return state;
}

FilterState predicted(FilterState state, std::initializer_list<double> intervals) {
  const PreciseEphemeris none({}, {}, {});
  for (const double t : intervals) predict_state(state, t, nullptr, none, PppParameters{});
  return state;
}

// Returns position and velocity, with their covariance, relative to the place: east, north and up.
Eigen::Matrix<double, 6, 1> motion_of(const FilterState& state) {
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(place));
  Eigen::Matrix<double, 6, 1> motion;
  motion << R * (state.x().segment<3>(S::position) - place), R * state.x().segment<3>(S::velocity);
  return motion;
}

Matrix6 covariance_of(const FilterState& state) {
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(place));
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
  return both * state.P().topLeftCorner<6, 6>() * both.transpose();
}

TEST(TimeUpdate, OneLongStepIsAsManyShortOnes) {
  for (const double sign : {1.0, -1.0}) {
    const FilterState start = moving({12.0, -3.0, 0.6});
    const FilterState one = predicted(start, {sign * 30.0});
    const FilterState three = predicted(start, {sign * 5.0, sign * 10.0, sign * 15.0});
    // The vertical turns with the way.
    EXPECT_LT((motion_of(one) - motion_of(three)).norm(), 3e-3);
    EXPECT_LT((covariance_of(one) - covariance_of(three)).norm(), 1e-3 * covariance_of(one).norm());
  }
}

TEST(TimeUpdate, AVerticalSpeedDecaysToThatOfRoads) {
  const PppParameters parameters;
  const FilterState later =
      predicted(moving({10.0, 0.0, 2.0}), {10.0 * parameters.vertical_speed_time});
  const auto motion = motion_of(later);
  EXPECT_NEAR(motion[3], 10.0, 0.01);
  EXPECT_NEAR(motion[5], 0.0, 0.01);
  EXPECT_NEAR(motion[2], 2.0 * parameters.vertical_speed_time, 0.5);
  EXPECT_NEAR(std::sqrt(covariance_of(later)(5, 5)), parameters.vertical_speed_sigma, 1e-3);
}

TEST(TimeUpdate, ACovarianceStaysSymmetricAndPositive) {
  const Matrix6 P = covariance_of(predicted(moving({12.0, 0.0, 0.0}), {0.1, 1.0, -1.0, 30.0}));
  EXPECT_LT((P - P.transpose()).norm(), 1e-9 * P.norm());
  EXPECT_GT(P.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
}

}  // namespace
}  // namespace maploop::ppp
