#include "ppp/integers/lambda.h"

#include <array>
#include <cmath>
#include <limits>

namespace maploop::ppp {
namespace {

constexpr int most_steps = 20000;  // of a search; one that succeeds takes some hundreds

}  // namespace

bool Lambda::decorrelate(const Vector& a, const Matrix& covariance) {
  const auto n = a.size();
  z_ = a;
  Z_ = Matrix::Identity(n, n);
  factorize(covariance);
  if (!(D_.minCoeff() > 0.0) || !D_.allFinite()) return false;
  reduce();
  z_ = Z_.transpose() * a;
  return true;
}

void Lambda::factorize(Matrix Q) {
  const Eigen::Index n = Q.rows();
  L_ = Matrix::Identity(n, n);
  D_.setZero(n);
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    D_[i] = Q(i, i);
    if (!(D_[i] > 0.0)) return;
    L_.row(i).head(i) = Q.row(i).head(i) / D_[i];
    Q.topLeftCorner(i, i) -= D_[i] * L_.row(i).head(i).transpose() * L_.row(i).head(i);
  }
}

// Ambiguity `from` loses a multiple of `other`, so that they are correlated less.
void Lambda::subtract(int from, int other) {
  const double multiple = std::round(L_(other, from));
  if (multiple == 0.0) return;
  const Eigen::Index below = L_.rows() - other;
  L_.col(from).tail(below) -= multiple * L_.col(other).tail(below);
  Z_.col(from) -= multiple * Z_.col(other);
}

// Exchanges ambiguities k and k + 1; `variance` is that of the first given those after the second.
void Lambda::exchange(int k, double variance) {
  const double share = D_[k] / variance, link = D_[k + 1] * L_(k + 1, k) / variance;
  const double before = L_(k + 1, k);
  D_[k] = share * D_[k + 1];
  D_[k + 1] = variance;
  for (int j = 0; j < k; ++j) {
    const double upper = L_(k, j), lower = L_(k + 1, j);
    L_(k, j) = lower - before * upper;
    L_(k + 1, j) = share * upper + link * lower;
  }
  L_(k + 1, k) = link;
  const Eigen::Index below = L_.rows() - k - 2;
  L_.col(k).tail(below).swap(L_.col(k + 1).tail(below));
  Z_.col(k).swap(Z_.col(k + 1));
}

// The most precise ambiguities come to the end, where the search begins.
void Lambda::reduce() {
  constexpr double enough = 1.0 - 1e-9;  // an exchange that gains less could repeat for ever
  const int n = size();
  int k = n - 2, reduced_from = n - 2;
  while (k >= 0) {
    if (k <= reduced_from) {
      for (int i = k + 1; i < n; ++i) subtract(k, i);
    }
    const double variance = D_[k] + L_(k + 1, k) * L_(k + 1, k) * D_[k + 1];
    if (variance < enough * D_[k + 1]) {
      exchange(k, variance);
      reduced_from = k;
      k = n - 2;
    } else {
      --k;
    }
  }
}

double Lambda::success_rate(int count) const {
  double rate = 1.0;
  for (int i = size() - count; i < size(); ++i)
    rate *= std::erf(0.5 / std::sqrt(2.0 * D_[i]));  // 2 Phi(1 / (2 sigma)) - 1
  return rate;
}

// A depth-first search from the last ambiguity to the first, in the order of distance (Schnorr and
// Euchner), within the distance of the second best found so far.
std::optional<Lambda::Found> Lambda::search(int count) const {
  const int first = size() - count, last = size() - 1;
  Vector conditional = z_, integers = z_, step = Vector::Zero(z_.size());
  std::array<double, max_size + 1> distance{};  // of the ambiguities from each on
  Found found;
  found.distance = found.next_distance = std::numeric_limits<double>::infinity();
  const auto begin = [&](int k) {
    integers[k] = std::round(conditional[k]);
    step[k] = conditional[k] >= integers[k] ? 1.0 : -1.0;
  };
  const auto next = [&](int k) {  // alternates between both sides
    integers[k] += step[k];
    step[k] = -step[k] - (step[k] > 0.0 ? 1.0 : -1.0);
  };
  int k = last;
  begin(k);
  for (int steps = 0; steps < most_steps; ++steps) {
    const double off = conditional[k] - integers[k];
    const double so_far = distance[static_cast<std::size_t>(k) + 1] + off * off / D_[k];
    if (so_far >= found.next_distance) {
      if (k == last) return found;
      next(++k);
      continue;
    }
    if (k > first) {
      distance[static_cast<std::size_t>(k)] = so_far;
      --k;
      const auto after = last - k;
      conditional[k] =
          z_[k] +
          L_.col(k).segment(k + 1, after).dot((integers - conditional).segment(k + 1, after));
      begin(k);
      continue;
    }
    if (so_far < found.distance) {
      found.next_distance = found.distance;
      found.distance = so_far;
      found.integers = integers.tail(count);
    } else {
      found.next_distance = so_far;
    }
    next(k);
  }
  return {};
}

}  // namespace maploop::ppp
