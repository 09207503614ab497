// Evaluates rows by the state, and applies one by itself, apart from the rows of an epoch.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"

namespace maploop::ppp {

// Returns the product of a row's entries, from `first` on, with those of the state.
double value_of(const FilterState& state, const LinearRow& row, std::size_t first = 0);

// Returns the covariance of two measured quantities according to the state.
double predicted_covariance(const FilterState& state, const LinearRow& a, const LinearRow& b);
inline double predicted_variance(const FilterState& state, const LinearRow& row) {
  return predicted_covariance(state, row, row);
}

// Corrects the state. `dx` is working memory of the state's size.
void apply_row(FilterState& state, const LinearRow& row, Eigen::VectorXd& dx);

}  // namespace maploop::ppp
