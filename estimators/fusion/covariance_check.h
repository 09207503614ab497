// Is a matrix from outside a covariance?
#pragma once

#include <Eigen/Dense>

namespace maploop::fusion {

// Finite, symmetric to rounding, and positive semi-definite to rounding (of its largest variance).
template <int n>
bool is_covariance(const Eigen::Matrix<double, n, n>& C) {
  if (!C.allFinite() || C.diagonal().minCoeff() < 0.0) return false;
  constexpr double rounding = 1e-6;
  // Correlations, so that metres and radians count alike.
  const Eigen::Matrix<double, n, 1> sigma = C.diagonal().cwiseSqrt();
  Eigen::Matrix<double, n, n> correlation;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double scale = sigma[i] * sigma[j];
      if (scale == 0.0 && C(i, j) != 0.0) return false;
      correlation(i, j) = i == j ? 1.0 : (scale == 0.0 ? 0.0 : C(i, j) / scale);
    }
  }
  if (!((correlation - correlation.transpose()).cwiseAbs().maxCoeff() <= rounding)) return false;
  correlation.diagonal().array() += rounding;
  return Eigen::LLT<Eigen::Matrix<double, n, n>>(correlation).info() == Eigen::Success;
}

}  // namespace maploop::fusion
