// These tests compare measurement equations with numerical derivatives and hand-made cases.
#include <gtest/gtest.h>

#include <cmath>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/inertial_update.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/odometry_innovation.h"
#include "estimators/fusion/wheel_update.h"
#include "tests/estimators/fusion/busy_filter.h"
#include "tests/estimators/fusion/least_eigenvalue.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using Eigen::Vector3d;

template <int rows, class Make>
void expect_jacobian(const FilterState& state, const Make& make, double tolerance) {
  const Innovation<rows> innovation = make(state);
  const auto numerical = numerical_jacobian(
      [&](const StateVector& x) {
        FilterState moved = state;
        moved.x = x;
        return Eigen::Matrix<double, rows, 1>(-make(moved).residual);
      },
      state.x);
  EXPECT_LT((innovation.H - numerical).cwiseAbs().maxCoeff(), tolerance)
      << innovation.H - numerical;
}

TEST(OdometryJacobians, AgreeWithNumericalDerivatives) {
  const FilterState state = busy();
  const RelativeMotion m = agreeing_motion(state);
  const FusionParameters p;
  expect_jacobian<6>(
      state, [&](const FilterState& s) { return motion_innovation(s, m, p); }, 1e-7);
}

TEST(OdometryJacobians, OfALidarsMotionAgreeWithNumericalDerivatives) {
  const FilterState state = busy();
  RelativeMotion m = agreeing_motion(state);
  m.source = OdometrySource::lidar;
  const FusionParameters p;
  expect_jacobian<6>(
      state, [&](const FilterState& s) { return motion_innovation(s, m, p); }, 1e-7);
}

GnssFix busy_fix(const LocalFrame& frame) {
  GnssFix fix;
  fix.position = frame.to_geodetic({815.0, -452.0, 13.0});
  fix.position_covariance = Vector3d(2.0, 3.0, 6.0).asDiagonal();
  fix.velocity_enu = {-11.0, -6.5, 1.0};
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  return fix;
}

TEST(OtherJacobians, AgreeWithNumericalDerivatives) {
  const FilterState state = busy();
  const FusionParameters p;
  const LocalFrame frame({0.8552, 0.1465, 112.0});
  const GnssFix fix = busy_fix(frame);
  WheelSpeed wheel;
  wheel.speed = 13.0;
  wheel.sigma = 0.05;
  expect_jacobian<3>(
      state, [&](const FilterState& s) { return position_innovation(s, fix, frame, p); }, 1e-6);
  expect_jacobian<3>(
      state, [&](const FilterState& s) { return velocity_innovation(s, fix, 0.3, p); }, 1e-6);
  expect_jacobian<1>(
      state, [&](const FilterState& s) { return wheel_innovation(s, wheel, p); }, 1e-8);
  expect_jacobian<1>(
      state, [&](const FilterState& s) { return chained_azimuth_innovation(s, p); }, 1e-8);
}

// The offset contains the lasting part of the stated variance and R the remaining part; their sum
// must be the whole.
TEST(GnssPosition, ItsVarianceIsSplitAndNotLost) {
  FilterState state = busy();
  state.P.setZero();
  for (int i = index::gnss_offset_east; i <= index::gnss_offset_up; ++i) state.P(i, i) = 1.0;
  FusionParameters p;
  p.min_position_sigma = 1e-6;
  const LocalFrame frame({0.8552, 0.1465, 112.0});
  const GnssFix fix = busy_fix(frame);
  const Innovation<3> innovation = position_innovation(state, fix, frame, p);
  EXPECT_LT((innovation.covariance(state.P) - fix.position_covariance).norm(), 1e-9);
}

// While a filter converges, the sum of east and north is known long before each of them.
TEST(GnssPosition, StronglyCorrelatedFixesKeepTheCovariancePositive) {
  GnssFix fix = busy_fix(LocalFrame({0.8552, 0.1465, 112.0}));
  fix.position_covariance << 100.0, 98.0, -50.0, 98.0, 100.0, -48.0, -50.0, -48.0, 400.0;
  const LocalFrame frame(fix.position);
  const FusionParameters p;
  const auto least = [](const StateMatrix& P) { return least_eigenvalue(P.topLeftCorner<3, 3>()); };
  const Innovation<3> first = position_innovation(busy(), fix, frame, p);
  EXPECT_GT(least_eigenvalue(first.R), 0.0);
  FilterState state = initial_state(fix, frame, p);
  EXPECT_GT(least_eigenvalue(state.P), -1e-9);
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(apply_gnss_position(state, fix, frame, p).refused()) << i;
    ASSERT_GT(least(state.P), 0.0) << i;
    ASSERT_GT(least_eigenvalue(state.P), -1e-9) << i;
  }
}

TEST(OdometryInnovations, VanishWhereOdometryAgrees) {
  const FilterState state = busy();
  const RelativeMotion m = agreeing_motion(state);
  EXPECT_LT(motion_innovation(state, m, {}).residual.norm(), 1e-12);
}

TEST(OdometryInnovations, RotationIsWrappedAcrossSouth) {
  FilterState state = busy();
  state.x[index::clone_azimuth] = std::numbers::pi - 0.01;
  state.x[index::azimuth] = -std::numbers::pi + 0.02;
  state.x.segment<2>(index::pitch).setZero();
  state.x.segment<2>(index::clone_pitch).setZero();
  RelativeMotion m = agreeing_motion(state);
  m.rotation = Eigen::AngleAxisd(-0.031, Vector3d::UnitZ());
  EXPECT_NEAR(motion_innovation(state, m, {}).residual[5], -0.001, 1e-12);
}

TEST(OdometryInnovations, FloorsKeepAnOptimisticOdometryInItsPlace) {
  const FilterState state = busy();
  RelativeMotion m = agreeing_motion(state);
  m.covariance.setZero();
  const FusionParameters p;
  EXPECT_NEAR(std::sqrt(motion_innovation(state, m, p).R(0, 0)), 0.1 * p.min_speed_sigma, 1e-12);
  EXPECT_NEAR(std::sqrt(motion_innovation(state, m, p).R(5, 5)), p.min_rotation_sigma, 1e-12);
}

TEST(Arc, OfAConstantTurnIsTheDistance) {
  for (const double angle : {-0.3, -1e-4, 0.0, 0.05, 0.4}) {
    RelativeMotion m;
    const double length = -2.0;  // in reverse
    m.rotation = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
    m.translation = std::abs(angle) < 1e-9
                        ? Vector3d(length, 0.0, 0.0)
                        : Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0) * length / angle;
    m.covariance.topLeftCorner<3, 3>() = Vector3d(0.01, 0.04, 0.04).asDiagonal();
    const Arc travelled = arc(m);
    EXPECT_LT((travelled.displacement - Vector3d(length, 0.0, 0.0)).norm(), 1e-12) << angle;
    const double variance = motion_innovation(busy(), m, {}).R(0, 0);
    EXPECT_GE(variance, 0.01) << angle;
    EXPECT_LE(variance, 0.012) << angle;
  }
}

TEST(RollJacobian, AgreesWithNumericalDerivative) {
  FilterState state = busy();
  ImuSample s;
  s.specific_force_forward = 0.9;
  s.specific_force_left = 1.0;
  s.yaw_rate = 0.2;
  const LocalEarth earth(test_origin());
  // The analytical derivative neglects the change of gravity with height (1.5e-7 here).
  expect_jacobian<1>(
      state, [&](const FilterState& f) { return *roll_innovation(f, s, 0.1, earth, {}); }, 2e-7);
  s.six_axes = true;
  FusionParameters full;
  full.inertial_axes = InertialAxes::six;
  expect_jacobian<1>(
      state, [&](const FilterState& f) { return *roll_innovation(f, s, 0.1, earth, full); }, 2e-7);
  s.specific_force_up = 9.6;  // Gravity changes by 3.1e-6 a metre of height.
  expect_jacobian<1>(
      state, [&](const FilterState& f) { return up_innovation(f, s, 0.1, earth, full); }, 4e-6);
  for (const int axis : {0, 1}) {
    expect_jacobian<1>(
        state,
        [&](const FilterState& f) {
          return zero_tilt_rate_innovation(f, s, axis, 0.1, earth, full);
        },
        1e-4);
  }
}

TEST(Roll, IsNotTakenFromHardDriving) {
  FilterState state = busy();
  const LocalEarth earth(test_origin());
  ImuSample gentle;
  gentle.specific_force_forward = 0.9;
  EXPECT_TRUE(roll_innovation(state, gentle, 0.1, earth, {}));
  EXPECT_FALSE(roll_innovation(state, gentle, 0.0, earth, {})) << "no time since the last sample";
  ImuSample braking = gentle;
  braking.specific_force_forward = -5.0;
  EXPECT_FALSE(roll_innovation(state, braking, 0.1, earth, {}));
  ImuSample cornering = gentle;
  cornering.yaw_rate = 0.5;  // 6.6 m/s^2
  EXPECT_FALSE(roll_innovation(state, cornering, 0.1, earth, {}));
}

TEST(NavStateJacobian, AgreesWithNumericalDerivative) {
  FilterState state = busy();
  const auto output = [&](const StateVector& x) {
    FilterState moved = state;
    moved.x = x;
    const NavState nav = nav_state(moved, {}, {});
    Eigen::Matrix<double, 9, 1> y;
    y << nav.position_enu, nav.velocity_enu, nav.attitude.azimuth, nav.attitude.pitch,
        nav.attitude.roll;
    return y;
  };
  EXPECT_LT((nav_state_jacobian(state) - numerical_jacobian(output, state.x)).norm(), 1e-7);
  const NavState nav = nav_state(state, {}, {});
  EXPECT_EQ(nav.covariance, nav.covariance.transpose());
  EXPECT_GT(least_eigenvalue(nav.covariance), 0.0);
}

}  // namespace
}  // namespace maploop::fusion
