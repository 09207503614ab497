#include "estimators/fusion/fix_error.h"

#include <Eigen/Eigenvalues>

namespace maploop::fusion {

FixError split_error(const Eigen::Matrix3d& position_covariance,
                     const FusionParameters& parameters) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(position_covariance);
  const Eigen::Matrix3d& axes = parts.eigenvectors();
  const Eigen::Vector3d variances = parts.eigenvalues().cwiseMax(0.0);
  const double share = parameters.gnss_correlated;
  const Eigen::Vector3d roots = (share * variances).cwiseSqrt();
  return {axes * roots.asDiagonal() * axes.transpose(),
          axes * ((1.0 - share) * variances).asDiagonal() * axes.transpose()};
}

}  // namespace maploop::fusion
