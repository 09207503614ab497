#include "ppp/filter/row_update.h"

#include <span>

namespace maploop::ppp {

double value_of(const FilterState& state, const LinearRow& row, std::size_t first) {
  const auto x = state.x();
  double value = 0.0;
  for (std::size_t k = first; k < static_cast<std::size_t>(row.count); ++k)
    value += row.h[k] * x[row.indices[k]];
  return value;
}

double predicted_covariance(const FilterState& state, const LinearRow& a, const LinearRow& b) {
  const auto P = state.P();
  double covariance = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(b.count); ++k)
      covariance += a.h[i] * P(a.indices[i], b.indices[k]) * b.h[k];
  }
  return covariance;
}

void apply_row(FilterState& state, const LinearRow& row, Eigen::VectorXd& dx) {
  const auto n = static_cast<std::size_t>(row.count);
  dx.setZero();
  state.update(std::span(row.indices).first(n), std::span(row.h).first(n), row.y, row.variance, dx);
  state.x() += dx.head(state.size());
}

}  // namespace maploop::ppp
