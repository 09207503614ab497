#include "ppp/filter/row_update.h"

#include <span>

namespace maploop::ppp {

double predicted_variance(const FilterState& state, const LinearRow& row) {
  const auto P = state.P();
  double variance = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.count); ++i) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      variance += row.h[i] * P(row.indices[i], row.indices[k]) * row.h[k];
    }
  }
  return variance;
}

void apply_row(FilterState& state, const LinearRow& row, Eigen::VectorXd& dx) {
  const auto n = static_cast<std::size_t>(row.count);
  dx.setZero();
  state.update(std::span(row.indices).first(n), std::span(row.h).first(n), row.y, row.variance, dx);
  state.x() += dx.head(state.size());
}

}  // namespace maploop::ppp
