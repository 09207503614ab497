// Tests that the increment of a carried solution is what the epoch alone has measured.
#include "ppp/increment.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace increment_test {

using Eigen::Matrix3d, Eigen::Vector3d;

const Geodetic place{radians(33.98), radians(-117.33), 250.0};

// Rows of a measurement, its values and their covariance.
struct Rows {
  Eigen::MatrixXd H;
  Eigen::VectorXd z;
  Eigen::MatrixXd R;
};

void update(const Rows& rows, Vector3d& x, Matrix3d& P) {
  const Eigen::MatrixXd S = rows.H * P * rows.H.transpose() + rows.R;
  const Eigen::MatrixXd K = P * rows.H.transpose() * S.inverse();
  x += K * (rows.z - rows.H * x);
  P -= (K * rows.H * P).eval();
}

Matrix3d correlated(const Vector3d& sigma) {
  Matrix3d correlation;
  correlation << 1.0, 0.6, -0.3, 0.6, 1.0, 0.2, -0.3, 0.2, 1.0;
  return sigma.asDiagonal() * correlation * sigma.asDiagonal();
}

// Returns a solution that was carried to `place` and then measured, position and velocity alike.
// The vectors of the rows are relative to `place` and to no velocity, earth-fixed.
PppSolution solved(const Rows& position, const Rows& velocity) {
  PppSolution s;
  CarriedSolution c;
  c.position = ecef_from_geodetic(place);
  c.covariance = correlated({2.0, 1.0, 3.0});
  c.velocity_covariance = correlated({0.2, 0.3, 0.1});
  c.growth = 0.01 * Matrix3d::Identity();
  s.carried = c;
  Vector3d moved = Vector3d::Zero();
  s.covariance = c.covariance;
  update(position, moved, s.covariance);
  s.position = c.position + moved;
  s.velocity_covariance = c.velocity_covariance;
  update(velocity, s.velocity, s.velocity_covariance);
  return s;
}

const Rows all_axes{Matrix3d::Identity(), Vector3d(0.7, -0.4, 1.1), correlated({1.0, 2.0, 1.5})};
const Rows all_velocities{Matrix3d::Identity(), Vector3d(0.1, 0.2, -0.1),
                          correlated({0.1, 0.1, 0.2})};
const Rows one_axis{Eigen::RowVector3d(0.6, 0.0, 0.8), Eigen::VectorXd::Constant(1, 0.5),
                    Eigen::MatrixXd::Constant(1, 1, 0.25)};

TEST(Increment, IsTheMeasurementOfTheEpoch) {
  const PppSolution s = solved(all_axes, all_velocities);
  const auto increment = increment_of(s);
  ASSERT_TRUE(increment);
  const Matrix3d R = rotation_enu_ecef(place);
  const Vector3d measured = R.transpose() * increment->position + s.position - s.carried->position;
  EXPECT_LT((measured - all_axes.z).norm(), 1e-5);
  const Matrix3d covariance = R.transpose() * increment->position_covariance * R;
  EXPECT_LT((covariance - all_axes.R).norm(), 1e-5);
  EXPECT_LT((R.transpose() * increment->velocity_enu - all_velocities.z).norm(), 1e-6);
  EXPECT_LT((R.transpose() * increment->velocity_covariance * R - all_velocities.R).norm(), 1e-6);
  EXPECT_LT((increment->growth - s.carried->growth).norm(), 1e-9);
}

TEST(Increment, OfOneAxisLeadsToTheSameSolution) {
  const PppSolution s = solved(one_axis, all_velocities);
  const auto increment = increment_of(s);
  ASSERT_TRUE(increment);
  const Matrix3d R = rotation_enu_ecef(place);
  const Rows rows{Matrix3d::Identity(),
                  R.transpose() * increment->position + s.position - s.carried->position,
                  R.transpose() * increment->position_covariance * R};
  Vector3d x = Vector3d::Zero();
  Matrix3d P = s.carried->covariance;
  update(rows, x, P);
  EXPECT_LT((x - (s.position - s.carried->position)).norm(), 1e-3);
  EXPECT_LT((P - s.covariance).norm(), 1e-2);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(increment->position_covariance);
  EXPECT_GT(parts.eigenvalues()[1], 1e3) << "two axes were not measured";
}

TEST(Increment, OfASolutionThatIsNotCarriedThereIsNone) {
  PppSolution s = solved(all_axes, all_velocities);
  s.carried.reset();
  EXPECT_FALSE(increment_of(s));
}

TEST(Increment, AnAxisThatBecameMoreCertainIsNoGrowth) {
  PppSolution s = solved(all_axes, all_velocities);
  const Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(s.position));
  s.carried->growth = R.transpose() * Vector3d(0.2, -0.1, 0.3).asDiagonal() * R;
  const auto increment = increment_of(s);
  ASSERT_TRUE(increment);
  const Matrix3d expected = Vector3d(0.2, 0.0, 0.3).asDiagonal();
  EXPECT_LT((increment->growth - expected).norm(), 1e-9);
}

}  // namespace increment_test
}  // namespace maploop::ppp
