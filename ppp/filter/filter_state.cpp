#include "ppp/filter/filter_state.h"

#include <algorithm>

namespace maploop::ppp {

void FilterState::clear() {
  ambiguities_.clear();
  ambiguities_.reserve(max_ambiguities);
  x_.setZero();
  P_.setZero();
}

void FilterState::set(int index, double value, double sigma) {
  x_[index] = value;
  P_.row(index).head(size()).setZero();
  P_.col(index).head(size()).setZero();
  P_(index, index) = sigma * sigma;
}

int FilterState::ambiguity(Satellite satellite) const {
  const auto at = std::find(ambiguities_.begin(), ambiguities_.end(), satellite);
  return at == ambiguities_.end() ? -1 : fixed + static_cast<int>(at - ambiguities_.begin());
}

int FilterState::add_ambiguity(Satellite satellite, double value, double sigma) {
  if (ambiguities_.size() == max_ambiguities) return -1;
  ambiguities_.push_back(satellite);
  set(size() - 1, value, sigma);
  return size() - 1;
}

void FilterState::remove_ambiguity(Satellite satellite) {
  const int at = ambiguity(satellite);
  if (at < 0) return;
  const int last = size() - 1;
  if (at != last) {
    const double variance = P_(last, last);
    x_[at] = x_[last];
    P_.row(at).head(size()) = P_.row(last).head(size()).eval();
    P_.col(at).head(size()) = P_.row(at).head(size()).transpose().eval();
    P_(at, at) = variance;
    ambiguities_[static_cast<std::size_t>(at - fixed)] = ambiguities_.back();
  }
  ambiguities_.pop_back();
}

void FilterState::update(std::span<const int> indices, std::span<const double> h, double y,
                         double variance, Eigen::VectorXd& dx) {
  const int n = size();
  auto column = column_.head(n);
  column.setZero();
  for (std::size_t k = 0; k < indices.size(); ++k) column += h[k] * P_.col(indices[k]).head(n);
  double innovation = y, s = variance;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    s += h[k] * column[indices[k]];
    innovation -= h[k] * dx[indices[k]];
  }
  dx.head(n) += column * (innovation / s);
  // Only one half is computed and the other is copied, because a difference between them would grow
  // from epoch to epoch.
  const double inverse = 1.0 / s;
  for (int i = 0; i < n; ++i) {
    P_.col(i).head(i + 1) -= column.head(i + 1) * (column[i] * inverse);
    P_.row(i).head(i) = P_.col(i).head(i).transpose();
  }
}

}  // namespace maploop::ppp
