#include "ppp/increment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// A direction whose variance the epoch has reduced by less than this share was not measured.
constexpr double least_gain = 1e-4;

struct Measured {
  Vector3d value;
  Matrix3d covariance;
};

// (28) of METHOD.md. Precondition: the covariance before is positive definite.
Measured measured_between(const Vector3d& before, const Matrix3d& covariance_before,
                          const Vector3d& after, const Matrix3d& covariance_after) {
  const Eigen::LLT<Matrix3d> root(covariance_before);
  const Matrix3d half = root.matrixL().solve(covariance_after);
  const Matrix3d ratio = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(0.5 * (ratio + ratio.transpose()));
  const Matrix3d axes = root.matrixL() * parts.eigenvectors();
  const Vector3d moved = parts.eigenvectors().transpose() * root.matrixL().solve(after - before);
  Measured measured{before, Matrix3d::Zero()};
  for (int i = 0; i < 3; ++i) {
    const double gain = 1.0 - parts.eigenvalues()[i];
    const bool seen = gain >= least_gain;
    if (seen) measured.value += axes.col(i) * (moved[i] / gain);
    const double variance = seen ? (1.0 - gain) / gain : 1.0 / least_gain;
    measured.covariance += variance * axes.col(i) * axes.col(i).transpose();
  }
  return measured;
}

// Correlations may let the covariance shrink along an axis, which is no growth.
Matrix3d positive_part(const Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(symmetric);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() *
         parts.eigenvectors().transpose();
}

}  // namespace

std::optional<GnssIncrement> increment_of(const PppSolution& s) {
  if (!s.carried) return {};
  const Measured position =
      measured_between(s.carried->position, s.carried->covariance, s.position, s.covariance);
  const Measured velocity = measured_between(s.carried->velocity, s.carried->velocity_covariance,
                                             s.velocity, s.velocity_covariance);
  const Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(s.position));
  return GnssIncrement{R * (position.value - s.position), R * position.covariance * R.transpose(),
                       R * velocity.value, R * velocity.covariance * R.transpose(),
                       R * positive_part(s.carried->growth) * R.transpose()};
}

}  // namespace maploop::ppp
