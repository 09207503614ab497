// This check decides whether a matrix from outside the filter is a covariance.
#pragma once

#include <Eigen/Dense>

namespace maploop::fusion {

// Returns whether `C` is finite and, up to rounding, symmetric and positive semi-definite. The
// rounding is 1e-6 of the correlations.
template <int n>
bool is_covariance(const Eigen::Matrix<double, n, n>& C) {
  if (!C.allFinite() || C.diagonal().minCoeff() < 0.0) return false;
  constexpr double rounding = 1e-6;
  // Correlations are compared, so that metres and radians have equal weight.
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
