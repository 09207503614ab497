// Tests how a motion that other sensors have measured moves the state of the PPP filter.
#include "ppp/filter/carry.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace carry_test {

using Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using S = FilterState;

const Geodetic place{radians(33.98), radians(-117.33), 250.0};

Vector3d earth_fixed(const Vector3d& enu) {
  return rotation_enu_ecef(place).transpose() * enu;
}

Vector3d enu_of(const Vector3d& earth_fixed) {
  return rotation_enu_ecef(place) * earth_fixed;
}

CarriedMotion motion_of(const Vector3d& displacement_enu) {
  CarriedMotion motion;
  motion.interval = 1.0;
  motion.displacement = earth_fixed(displacement_enu);
  motion.velocity = earth_fixed({1.0, 9.0, 0.2});
  return motion;
}

// Makes a state that has been carried once, with these lasting errors.
FilterState carried_state(double turn = 0.0, double scale = 0.0) {
  FilterState state;
  const Vector3d p = ecef_from_geodetic(place);
  for (int i = 0; i < 3; ++i) {
    state.set(S::position + i, p[i], 2.0);
    state.set(S::velocity + i, 0.0, 1.0);
  }
  state.set(S::carried_turn, turn, 0.02);
  state.set(S::carried_scale, scale, 0.01);
  return state;
}

// Lasting errors that do not fade.
PppParameters constant() {
  PppParameters parameters;
  parameters.carried_turn_time = parameters.carried_scale_time = 1e6;
  return parameters;
}

TEST(Carry, MovesThePositionAndReplacesTheVelocity) {
  FilterState state = carried_state();
  carry(state, motion_of({3.0, 10.0, 0.5}), constant());
  const Vector3d moved = enu_of(state.x().segment<3>(S::position) - ecef_from_geodetic(place));
  EXPECT_TRUE(moved.isApprox(Vector3d(3.0, 10.0, 0.5), 1e-6));
  EXPECT_TRUE(enu_of(state.x().segment<3>(S::velocity)).isApprox(Vector3d(1.0, 9.0, 0.2), 1e-6));
}

TEST(Carry, TakesOffTheLastingErrorsOfDirectionAndLength) {
  FilterState state = carried_state(0.1, 0.02);  // it points to the left, and is too long
  carry(state, motion_of({0.0, 10.0, 0.0}), constant());
  const Vector3d moved = enu_of(state.x().segment<3>(S::position) - ecef_from_geodetic(place));
  EXPECT_NEAR(moved.x(), 10.0 / 1.02 * std::sin(0.1), 1e-4);
  EXPECT_NEAR(moved.y(), 10.0 / 1.02 * std::cos(0.1), 1e-4);
}

TEST(Carry, TheCovarianceFollowsTheNumericalDerivatives) {
  const PppParameters parameters = constant();
  const CarriedMotion motion = motion_of({3.0, 10.0, 0.5});
  const FilterState before = carried_state(0.05, 0.01);
  FilterState carried = before;
  carry(carried, motion, parameters);
  const int n = before.size();
  MatrixXd F(n, n);
  for (int i = 0; i < n; ++i) {
    constexpr double h = 1e-4;
    const auto after = [&](double by) {
      FilterState moved = before;
      moved.x()[i] += by;
      carry(moved, motion, parameters);
      return VectorXd(moved.x());
    };
    F.col(i) = (after(h) - after(-h)) / (2.0 * h);
  }
  const MatrixXd noise = carried.P() - F * before.P() * F.transpose();
  // The rest is the motion's white noise, which only the position and the velocity have.
  EXPECT_LT(noise.middleCols<2>(S::carried_turn).cwiseAbs().maxCoeff(), 1e-6);
  const auto own = noise.topLeftCorner<6, 6>();
  EXPECT_TRUE(own.isApprox(own.transpose(), 1e-9));
  EXPECT_GT(own.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-6);
  EXPECT_NEAR(own.trace(),
              6 * std::pow(parameters.carried_velocity_sigma, 2) +
                  3 * std::pow(parameters.carried_walk, 2) +
                  2 * std::pow(parameters.carried_speed_share, 2) * motion.velocity.squaredNorm(),
              1e-3);
}

TEST(Carry, LastingErrorsBeginWithTheFirstMotionAndFade) {
  PppParameters parameters;
  FilterState state = carried_state();
  state.set(S::carried_turn, 0.0, 0.0);
  CarriedMotion motion = motion_of({0.0, 0.0, 0.0});
  motion.turn_sigma = 0.05;
  carry(state, motion, parameters);
  EXPECT_NEAR(state.P()(S::carried_turn, S::carried_turn), 0.05 * 0.05, 1e-12) << "as it states";
  state.set(S::carried_turn, 0.04, 0.001);
  motion.interval = parameters.carried_turn_time;
  carry(state, motion, parameters);
  EXPECT_NEAR(state.x()[S::carried_turn], 0.04 / std::exp(1.0), 1e-12);
}

TEST(Carry, TheDirectionIsObservedByThePositions) {
  const PppParameters parameters = constant();
  FilterState state = carried_state();
  VectorXd dx(FilterState::capacity);
  for (int i = 1; i <= 20; ++i) {  // it drives north; the motion says 2 degrees to the left of it
    const double error = radians(2.0);
    carry(state, motion_of({-10.0 * std::sin(error), 10.0 * std::cos(error), 0.0}), parameters);
    const Vector3d truth = ecef_from_geodetic(place) + earth_fixed({0.0, 10.0 * i, 0.0});
    for (int axis = 0; axis < 3; ++axis) {
      const int index = S::position + axis;
      const double h = 1.0;
      dx.setZero();
      state.update({&index, 1}, {&h, 1}, truth[axis] - state.x()[index], 0.25, dx);
      state.x() += dx.head(state.size());
    }
  }
  EXPECT_NEAR(state.x()[S::carried_turn], radians(2.0), radians(0.5));
}

}  // namespace carry_test
}  // namespace maploop::ppp
