// These tests compare the update itself with the information form, and what is done with the rows
// of a measurement with hand-made cases.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/odometry_innovation.h"
#include "estimators/fusion/odometry_update.h"
#include "tests/estimators/fusion/busy_filter.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using Eigen::Vector3d;

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
