// Finds the integers nearest to real-valued ambiguities in the metric of their covariance: LAMBDA
// (Teunissen, "The least-squares ambiguity decorrelation adjustment", Journal of Geodesy 70, 1995),
// with the order of Chang, Yang and Zhou, "MLAMBDA", Journal of Geodesy 79, 2005.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace maploop::ppp {

class Lambda {
 public:
  static constexpr int max_size = 64;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_size, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_size, max_size>;

  // The integers of the best candidate, and the squared distances (in standard deviations) of the
  // best two from the real values.
  struct Found {
    Vector integers;
    double distance = 0.0, next_distance = 0.0;
  };

  // Takes ambiguities (cycles) and their covariance, which must be positive definite; at most
  // `max_size`. Returns false if it is not. The decorrelated ambiguities are z = Z' a, of which the
  // last is the most precise; Z and its inverse consist of integers.
  bool decorrelate(const Vector& a, const Matrix& covariance);
  int size() const { return static_cast<int>(z_.size()); }
  const Matrix& transformation() const { return Z_; }

  // Returns the probability that the last `count` decorrelated ambiguities are right when each is
  // rounded given those after it, which is a lower bound for search().
  double success_rate(int count) const;

  // Returns the best integers of the last `count` decorrelated ambiguities, or nothing if the
  // search takes more than a bounded number of steps.
  std::optional<Found> search(int count) const;

 private:
  void factorize(Matrix covariance);
  void reduce();
  void subtract(int from, int other);
  void exchange(int k, double variance);

  Vector z_, D_;  // D: conditional variances, given the ambiguities after each
  Matrix L_, Z_;  // covariance of z = L' D L, L lower triangular with a unit diagonal
};

}  // namespace maploop::ppp
