#include "ppp/filter/filter_state.h"

#include <algorithm>

namespace maploop::ppp {

void FilterState::clear() {
  entries_.clear();
  entries_.reserve(max_entries);
  x_.setZero();
  P_.setZero();
}

FilterState& FilterState::operator=(const FilterState& other) {
  entries_.reserve(max_entries);
  entries_ = other.entries_;
  x() = other.x();
  P() = other.P();
  return *this;
}

void FilterState::set(int index, double value, double sigma) {
  x_[index] = value;
  P_.row(index).head(size()).setZero();
  P_.col(index).head(size()).setZero();
  P_(index, index) = sigma * sigma;
}

void FilterState::forget(int index, double keep, double variance) {
  x_[index] *= keep;
  P_.row(index).head(size()) *= keep;
  P_.col(index).head(size()) *= keep;
  P_(index, index) += (1.0 - keep * keep) * variance;
}

int FilterState::find(Satellite satellite, Part part) const {
  const auto at = std::find(entries_.begin(), entries_.end(), SatelliteEntry{satellite, part});
  return at == entries_.end() ? -1 : fixed + static_cast<int>(at - entries_.begin());
}

int FilterState::add(Satellite satellite, Part part, double value, double sigma) {
  if (entries_.size() == max_entries) return -1;
  entries_.push_back({satellite, part});
  set(size() - 1, value, sigma);
  return size() - 1;
}

void FilterState::remove(Satellite satellite, Part part) {
  const int at = find(satellite, part);
  if (at < 0) return;
  const int last = size() - 1;
  if (at != last) {
    const double variance = P_(last, last);
    x_[at] = x_[last];
    // Rows first, then columns: neither overwrites what the other reads, but for P_(at, at).
    for (int i = 0; i < size(); ++i) P_(at, i) = P_(last, i);
    for (int i = 0; i < size(); ++i) P_(i, at) = P_(at, i);
    P_(at, at) = variance;
    entries_[static_cast<std::size_t>(at - fixed)] = entries_.back();
  }
  entries_.pop_back();
}

void FilterState::remove_ambiguities(Satellite satellite) {
  remove(satellite, Part::ambiguity);
  remove(satellite, Part::ionosphere_ambiguity);
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
