// These tests compare measurement equations with numerical derivatives and hand-made cases, and the
// update itself with the information form.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/inertial_update.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/nav_state_output.h"
#include "estimators/fusion/odometry_innovation.h"
#include "estimators/fusion/odometry_update.h"
#include "estimators/fusion/wheel_update.h"
#include "tests/estimators/fusion/least_eigenvalue.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using Eigen::Vector3d;

FilterState busy() {
  FilterState state;
  state.stamp = state.clone_stamp = state.start = SyntheticDrive::at(1.0);
  state.x = busy_state();
  state.P = busy_covariance();
  state.imu_stamp = state.stamp;
  state.acceleration = 1.3;
  state.front_known = true;
  return state;
}

// Returns a motion that agrees exactly with the state.
RelativeMotion agreeing_motion(const FilterState& state) {
  RelativeMotion m;
  m.status = OdometryStatus::ok;
  m.from = state.clone_stamp;
  m.stamp = m.from + from_seconds(0.1);
  m.rotation = Eigen::Quaterniond(Eigen::Matrix3d(
      rotation_enu_body(state.clone_attitude()).transpose() * rotation_enu_body(state.attitude())));
  const Eigen::AngleAxisd turn(m.rotation);
  const double half = 0.5 * turn.angle();
  const Vector3d chord = rotation_enu_body(state.clone_attitude()).transpose() * state.moved();
  Vector3d displacement = half / std::sin(half) * (Eigen::AngleAxisd(-half, turn.axis()) * chord);
  displacement.x() = state.x[index::distance];
  const Vector3d place(0.0, state.x[index::odometry_left], 0.0);
  displacement -= turn.angle() * turn.axis().cross(place);
  displacement.y() -= displacement.x() * state.x[index::odometry_course];
  m.translation = std::sin(half) / half * (Eigen::AngleAxisd(half, turn.axis()) * displacement);
  m.covariance.diagonal() << 1e-4, 2e-4, 3e-4, 1e-7, 2e-7, 3e-7;
  return m;
}

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

TEST(JosephUpdate, EqualsTheInformationForm) {
  const FilterState prior = busy();
  Innovation<6> innovation = motion_innovation(prior, agreeing_motion(prior), {});
  innovation.residual << 0.01, -0.02, 0.03, 1e-3, -2e-3, 3e-3;
  StateVector x = prior.x;
  StateMatrix P = prior.P;
  joseph_update(x, P, innovation);

  const Eigen::MatrixXd before = prior.P;
  const Eigen::MatrixXd information =
      before.inverse() + innovation.H.transpose() * innovation.R.inverse() * innovation.H;
  const Eigen::MatrixXd expected = information.inverse();
  const StateVector correction =
      expected * innovation.H.transpose() * innovation.R.inverse() * innovation.residual;
  EXPECT_LT(((P - expected).array() / expected.diagonal().maxCoeff()).abs().maxCoeff(), 1e-9);
  EXPECT_LT((x - prior.x - correction).norm(), 1e-9);
  EXPECT_EQ(P, P.transpose());
}

TEST(Clone, IsFullyCorrelatedAndTakenTwiceTheSame) {
  FilterState state = busy();
  take_clone(state);
  EXPECT_EQ(state.x.segment<3>(index::azimuth), state.x.segment<3>(index::clone_azimuth));
  const auto block = [&](int i, int j) { return state.P.block<3, 3>(i, j).eval(); };
  EXPECT_EQ(block(index::azimuth, index::azimuth),
            block(index::clone_azimuth, index::clone_azimuth));
  EXPECT_EQ(block(index::azimuth, index::azimuth), block(index::azimuth, index::clone_azimuth));
  EXPECT_EQ(state.P, state.P.transpose());
  EXPECT_EQ(state.x[index::distance], 0.0);
  EXPECT_EQ(state.P.row(index::distance).norm(), 0.0);
  const FilterState once = state;
  take_clone(state);
  EXPECT_EQ(state.x, once.x);
  EXPECT_EQ(state.P, once.P);
}

class ApplyOdometry : public ::testing::Test {
 protected:
  ApplyOdometry() : state_(busy()), motion_(agreeing_motion(state_)) {
    state_.P *= 1e-2;
    state_.stamp = motion_.stamp;
  }
  FilterState state_;
  RelativeMotion motion_;
  FusionParameters parameters_;
};

TEST_F(ApplyOdometry, AppliesAndTakesTheClone) {
  EXPECT_EQ(apply_odometry(state_, motion_, parameters_), Outcome{});
  EXPECT_EQ(state_.odometry_applied, 1u);
  EXPECT_EQ(state_.odometry_stamp, motion_.stamp);
  EXPECT_EQ(state_.clone_stamp, motion_.stamp);
}

TEST_F(ApplyOdometry, FailedOdometryOnlyTakesTheClone) {
  motion_.status = OdometryStatus::too_few_inliers;
  const StateVector before = state_.x;
  EXPECT_EQ(apply_odometry(state_, motion_, parameters_), refused(Reason::odometry_not_ok));
  EXPECT_EQ(state_.x.head<index::distance>(), before.head<index::distance>());
  EXPECT_EQ(state_.odometry_refused, 1u);
  EXPECT_EQ(state_.gated_in_a_row, 0);
  EXPECT_EQ(state_.clone_stamp, motion_.stamp);
}

TEST_F(ApplyOdometry, UnknownIntervalIsRefused) {
  motion_.from -= from_seconds(0.01);
  EXPECT_EQ(apply_odometry(state_, motion_, parameters_), refused(Reason::interval_unknown));
}

TEST_F(ApplyOdometry, GatesSpeedAndRotationApart) {
  RelativeMotion fast = motion_;
  fast.translation *= 4.0;
  FilterState state = state_;
  EXPECT_EQ(apply_odometry(state, fast, parameters_), refused(Reason::speed_gate));
  RelativeMotion turned = motion_;
  turned.rotation = Eigen::AngleAxisd(0.1, Vector3d::UnitZ()) * motion_.rotation;
  turned.translation = Eigen::AngleAxisd(0.05, Vector3d::UnitZ()) * motion_.translation;
  state = state_;
  EXPECT_EQ(apply_odometry(state, turned, parameters_), refused(Reason::rotation_gate));
  EXPECT_EQ(state.gated_in_a_row, 1);
  EXPECT_EQ(state.odometry_refused, 1u);
}

TEST_F(ApplyOdometry, ARowOfGatedMotionsMakesTheFilterDoubtItself) {
  parameters_.recover_after = 3;
  motion_.translation *= 1.8;  // 10 m/s
  for (int i = 0; i < 2; ++i) {
    FilterState again = state_;
    EXPECT_EQ(apply_odometry(again, motion_, parameters_), refused(Reason::speed_gate));
    state_.gated_in_a_row = again.gated_in_a_row;
  }
  EXPECT_EQ(apply_odometry(state_, motion_, parameters_), Outcome{});
  EXPECT_EQ(state_.recoveries, 1u);
  EXPECT_EQ(state_.gated_in_a_row, 3) << "until a motion passes by itself";
}

// The velocity is against the travel. A vehicle that leans far back could follow it upside down.
TEST(ApplyVelocity, DoesNotTurnTheVehicleUpsideDown) {
  FusionParameters p;
  p.gnss_velocity_gate = 1e9;
  FilterState state;
  state.x[index::speed] = 10.0;
  state.x[index::pitch] = 0.7;
  state.P = 1e-6 * StateMatrix::Identity();
  state.P(index::pitch, index::pitch) = 1.0;
  GnssFix fix;
  fix.velocity_enu = {0.0, -10.0, 0.0};
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  const StateVector x = state.x;
  const StateMatrix P = state.P;
  EXPECT_EQ(apply_gnss_velocity(state, fix, 0.0, p), refused(Reason::implausible_tilt));
  EXPECT_EQ(state.x, x);
  EXPECT_EQ(state.P, P);

  fix.velocity_enu = {0.0, 10.0, 0.0};
  state.x[index::pitch] = 1.2;
  EXPECT_EQ(apply_gnss_velocity(state, fix, 0.0, p), Outcome{}) << "it leans less than before";
  EXPECT_LT(state.x[index::pitch], 1.2);
}

TEST_F(ApplyOdometry, ACorrectionThatLeansTheVehicleOverIsTakenBack) {
  parameters_.max_tilt = 0.06;  // the state's pitch is 0.07
  motion_.rotation = motion_.rotation * Eigen::AngleAxisd(-1e-4, Eigen::Vector3d::UnitY());
  const StateVector before = state_.x;
  EXPECT_EQ(apply_odometry(state_, motion_, parameters_), refused(Reason::implausible_tilt));
  EXPECT_EQ(state_.x.head<index::distance>(), before.head<index::distance>());
}

}  // namespace
}  // namespace maploop::fusion
