// Judges and applies one row by itself, apart from the rows of an epoch.
#pragma once

#include <Eigen/Core>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"

namespace maploop::ppp {

// Returns the variance of the measured quantity according to the state.
double predicted_variance(const FilterState& state, const LinearRow& row);

// Corrects the state. `dx` is working memory of the state's size.
void apply_row(FilterState& state, const LinearRow& row, Eigen::VectorXd& dx);

}  // namespace maploop::ppp
