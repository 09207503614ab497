#include "tools/calibrate/extrinsics/robust_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "msgs/median.h"

namespace maploop::extrinsics {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double cauchy = 2.385;  // 95 % efficient where all errors are normal
constexpr int reweightings = 8;
constexpr double least_noise = 1e-7;

struct Weighted {
  MatrixXd normal;
  VectorXd gradient;
  std::map<int, VectorXd> blocks;  // parts of the gradient
};

// Returns what is left of a residual after the step, in units of the noise.
VectorXd left_over(const Equation& e, const VectorXd& step, const VectorXd& noise) {
  return (e.residual - e.jacobian * step).cwiseQuotient(noise);
}

VectorXd noise_of(std::span<const Equation> equations, const VectorXd& step) {
  VectorXd noise(equations.front().residual.size());
  std::vector<double> sizes(equations.size());
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    for (std::size_t k = 0; k < equations.size(); ++k)
      sizes[k] = equations[k].residual[i] - equations[k].jacobian.row(i).dot(step);
    noise[i] = std::max(least_noise, 1.4826 * median_size(sizes));
  }
  return noise;
}

Weighted weigh(std::span<const Equation> equations, const VectorXd& step, const VectorXd& noise) {
  const Eigen::Index n = step.size();
  Weighted w{MatrixXd::Zero(n, n), VectorXd::Zero(n), {}};
  for (const Equation& e : equations) {
    const VectorXd r = left_over(e, step, noise);
    const double size = r.squaredNorm() / static_cast<double>(r.size()) / (cauchy * cauchy);
    const MatrixXd J = noise.cwiseInverse().asDiagonal() * e.jacobian;
    const VectorXd part = J.transpose() * r / (1.0 + size);
    w.normal += J.transpose() * J / (1.0 + size);
    w.gradient += part;
    const auto [block, first] = w.blocks.try_emplace(e.block, part);
    if (!first) block->second += part;
  }
  return w;
}

// Enlarges the standard deviations of N^-1 to those that the blocks show.
MatrixXd covariance_of(const MatrixXd& inverse, const Weighted& w) {
  MatrixXd sum = MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (const auto& [block, part] : w.blocks) sum += part * part.transpose();
  // Few blocks say little of their own spread: the variance of Student's distribution.
  const double blocks = static_cast<double>(w.blocks.size());
  if (blocks < 4.0) return 4.0 * inverse;
  const MatrixXd shown = blocks / (blocks - 3.0) * inverse * sum * inverse;
  const VectorXd larger =
      shown.diagonal().cwiseQuotient(inverse.diagonal()).cwiseMax(1.0).cwiseSqrt();
  return larger.asDiagonal() * inverse * larger.asDiagonal();
}

}  // namespace

double median_size(std::vector<double> numbers) {
  if (numbers.empty()) return 0.0;
  for (double& x : numbers) x = std::abs(x);
  return median(numbers);
}

Fit robust_fit(std::span<const Equation> equations, const VectorXd& from_prior,
               const VectorXd& prior_sigma) {
  const VectorXd information = prior_sigma.cwiseAbs2().cwiseInverse();
  Fit fit;
  fit.step = VectorXd::Zero(prior_sigma.size());
  fit.noise = noise_of(equations, fit.step);
  Weighted w;
  MatrixXd inverse;
  for (int i = 0; i < reweightings; ++i) {
    w = weigh(equations, fit.step, fit.noise);
    w.normal.diagonal() += information;
    const VectorXd pull = information.cwiseProduct(from_prior + fit.step);
    inverse = w.normal.ldlt().solve(MatrixXd::Identity(w.normal.rows(), w.normal.cols()));
    fit.step += inverse * (w.gradient - pull);
    fit.noise = noise_of(equations, fit.step);
  }
  w = weigh(equations, fit.step, fit.noise);
  w.normal.diagonal() += information;
  inverse = w.normal.ldlt().solve(MatrixXd::Identity(w.normal.rows(), w.normal.cols()));
  fit.covariance = covariance_of(inverse, w);
  const auto count = static_cast<double>(equations.size());
  fit.cost = 2.0 * count * fit.noise.array().log().sum() +
             (from_prior + fit.step).cwiseAbs2().dot(information);
  return fit;
}

}  // namespace maploop::extrinsics
