// Tests fixes of a receiver that is carried by the filter's own motion: their increments count
// once.
#include <gtest/gtest.h>

#include <cmath>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/initial_state.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace carried_fix_test {

using namespace maploop::testing;
using Eigen::Matrix3d, Eigen::Vector3d;

const LocalFrame frame({0.8552, 0.1465, 112.0});

FilterState standing(double position_sigma) {
  FilterState state;
  state.stamp = state.clone_stamp = state.start = SyntheticDrive::at(1.0);
  state.P.block<3, 3>(index::east, index::east) =
      position_sigma * position_sigma * Matrix3d::Identity();
  copy_to_clone(state);
  return state;
}

GnssFix fix_with(const GnssIncrement& increment) {
  GnssFix fix;
  fix.stamp = fix.velocity_stamp = SyntheticDrive::at(1.0);
  fix.position = frame.to_geodetic({1.0, 0.0, 0.0});
  fix.position_covariance = 0.04 * Matrix3d::Identity();
  fix.velocity_enu = {3.0, 4.0, 0.0};
  fix.velocity_covariance = 0.01 * Matrix3d::Identity();
  fix.increment = increment;
  return fix;
}

GnssIncrement increment_with(double variance) {
  GnssIncrement increment;
  increment.position_covariance = variance * Matrix3d::Identity();
  increment.velocity_covariance = 0.09 * Matrix3d::Identity();
  return increment;
}

TEST(CarriedFix, TheIncrementTakesTheFixesPlace) {
  GnssIncrement increment = increment_with(9.0);
  increment.position = {0.5, -2.0, 0.3};
  increment.velocity_enu = {3.5, 4.5, 0.1};
  const GnssFix fix = fix_with(increment);
  const FilterState state = standing(1.0);
  FusionParameters p;
  p.min_position_sigma = p.min_velocity_sigma = p.slip_sigma = 0.0;
  const Innovation<3> position = position_innovation(state, fix, frame, p);
  EXPECT_LT((position.residual - Vector3d(1.5, -2.0, 0.3)).norm(), 1e-6);
  EXPECT_LT((position.R - increment.position_covariance).norm(), 1e-12);
  EXPECT_EQ(position.H.middleCols<3>(index::gnss_offset_east).norm(), 0.0);
  const Innovation<3> velocity = velocity_innovation(state, fix, 0.0, p);
  EXPECT_LT((velocity.residual - increment.velocity_enu).norm(), 1e-12);
  EXPECT_LT((velocity.R - increment.velocity_covariance).norm(), 1e-12);
}

TEST(CarriedFix, ItsGrowthLeavesTheMotionSinceTheCloneAsWellKnown) {
  FilterState state = standing(1.0);
  GnssIncrement increment = increment_with(1e8);
  increment.growth = Vector3d(0.5, 0.25, 0.75).asDiagonal();
  ASSERT_FALSE(
      apply_gnss_position(state, fix_with(increment), frame, FusionParameters{}).refused());
  EXPECT_NEAR(state.P(index::east, index::east), 1.5, 1e-6);
  EXPECT_NEAR(state.P(index::north, index::north), 1.25, 1e-6);
  EXPECT_NEAR(state.P(index::up, index::up), 1.75, 1e-6);
  StateVector moved = StateVector::Zero();
  moved[index::east] = 1.0;
  moved[index::clone_east] = -1.0;
  EXPECT_NEAR(moved.dot(state.P * moved), 0.0, 1e-9);
}

// A receiver whose error lasts: its variance is in balance between its motion and what it measures.
// The filter's own motion is far better, and still it must not become surer than the receiver.
TEST(CarriedFix, AHundredOfThemAreNoSurerThanTheReceiver) {
  const double growth = 0.04, noise = 4.0, own_growth = 1e-4;
  double receiver = 1.0;
  FilterState state = standing(1.0), repeated = state;
  for (int i = 0; i < 100; ++i) {
    const double carried = receiver + growth;
    receiver = carried * noise / (carried + noise);
    GnssIncrement increment = increment_with(noise);
    increment.growth = growth * Matrix3d::Identity();
    GnssFix fix = fix_with(increment);
    fix.position_covariance = receiver * Matrix3d::Identity();
    for (FilterState* s : {&state, &repeated}) {
      doubt_position_with_clone(*s, own_growth * Matrix3d::Identity());
    }
    ASSERT_FALSE(apply_gnss_position(state, fix, frame, FusionParameters{}).refused());
    ASSERT_FALSE(apply_gnss_position(repeated, fix.alone(), frame, FusionParameters{}).refused());
  }
  EXPECT_GT(state.P(index::east, index::east), 0.95 * receiver);
  EXPECT_LT(state.P(index::east, index::east), 1.2 * receiver);
  EXPECT_LT(repeated.P(index::east, index::east), 0.5 * receiver) << "what increments prevent";
}

TEST(CarriedFix, ADamagedIncrementIsRefused) {
  GnssFix fix = fix_with(increment_with(9.0));
  fix.available = fix.stamp;
  ASSERT_EQ(check_fix(fix, {}), Reason::none);
  fix.increment->position.x() = std::nan("");
  EXPECT_EQ(check_fix(fix, {}), Reason::not_finite);
  fix.increment = increment_with(-1.0);
  EXPECT_EQ(check_fix(fix, {}), Reason::invalid_covariance);
}

}  // namespace carried_fix_test
}  // namespace maploop::fusion
