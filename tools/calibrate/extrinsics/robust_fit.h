// This file fits parameters to measurements some of which are wrong, and says how well each is
// known.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace maploop::extrinsics {

// One linearized measurement of up to three components: residual = jacobian * step + noise.
struct Equation {
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 8>;
  using Residual = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;

  Jacobian jacobian;
  Residual residual;
  int block = 0;  // stretch of the drive; the errors of two blocks are taken to be independent
};

struct Fit {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd noise;  // 1 sigma of each component of a residual, from their median
  double cost = 0.0;      // -2 log likelihood after the step, but for a constant
};

// Returns the step of iteratively reweighted least squares with Cauchy's weights, each component
// of the residuals in units of its own noise. `from_prior` is the current estimate minus what was
// known before, whose standard deviations are `prior_sigma`: they keep finite what the
// measurements say nothing about.
//
// The covariance is the inverse of the normal matrix N, but with a standard deviation as large as
// that of B/(B - 3) N^-1 (sum of s_b s_b^T) N^-1, where s_b is the gradient's part of block b of B:
// errors that are correlated within a block count as they are (Huber, "The behavior of maximum
// likelihood estimates under nonstandard conditions", 1967; Liang and Zeger, Biometrika 73, 1986).
// With fewer than four blocks it is twice the standard deviation of N^-1.
// Precondition: there are equations, all of one size.
Fit robust_fit(std::span<const Equation> equations, const Eigen::VectorXd& from_prior,
               const Eigen::VectorXd& prior_sigma);

// Returns the median of the numbers without their signs; 0 if there are none.
double median_size(std::vector<double> numbers);

}  // namespace maploop::extrinsics
