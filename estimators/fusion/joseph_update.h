// Kalman measurement update in Joseph's form, with a chi-square gate (Bar-Shalom, Li and
// Kirubarajan 2001, 5.2 and 5.4).
#pragma once

#include <Eigen/Core>
#include <initializer_list>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/outcome.h"

namespace maploop::fusion {

// z - h(x), its derivative H = dh/dx and the measurement's noise R, `rows` at a time.
template <int rows>
struct Innovation {
  Eigen::Matrix<double, rows, 1> residual;
  Eigen::Matrix<double, rows, index::count> H;
  Eigen::Matrix<double, rows, rows> R;

  Eigen::Matrix<double, rows, rows> covariance(const StateMatrix& P) const;

  // Normalized innovation squared: chi-square with `rows` degrees of freedom when all is well.
  double nis(const StateMatrix& P) const;
};

// The states that an update leaves as they are: considered, what is not known of them counts in
// the gain and in the covariance (Schmidt 1966).
using Considered = std::initializer_list<int>;

// Correction of the state and covariance after it: (I - KH) P (I - KH)^T + K R K^T multiplied out,
// which holds for any gain, so that a gain's rounding is of second order; at the cost of the rows
// alone.
template <int rows>
void joseph_update(StateVector& x, StateMatrix& P, const Innovation<rows>& innovation,
                   Considered considered = {});

// One measurement at the state's stamp, whatever its kind: corrects, or refuses with `reason` what
// contradicts the prediction by more than `gate` (chi-square of `rows` degrees of freedom).
template <int rows>
Outcome apply_gated(FilterState& state, const Innovation<rows>& innovation, double gate,
                    Reason reason, Considered considered = {}) {
  if (!(innovation.nis(state.P) <= gate)) return refused(reason);
  joseph_update(state.x, state.P, innovation, considered);
  return {};
}

// Compiled once, in joseph_update.cpp.
extern template struct Innovation<1>;
extern template struct Innovation<2>;
extern template struct Innovation<3>;

}  // namespace maploop::fusion
